# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture in a viewport: what has changed of the scene goes over, and the picture gets better until the next change. Needs
no window: what is seen is a View."""
from .accumulator import Accumulator, Look
from .cache import Cache
from .camera import view_keys
from .notices import Notices
from .scene_writer import SceneWriter

# The scene's own picture, which nobody renders: views bring their cameras.
_SIZE = (512, 512)
_CAMERA = {"position": [0, 0, 1], "look_at": [0, 0, 0], "vertical_fov": 40}


class View:
    """What a viewport of (width, height) pixels shows, by its matrices as Blender has them. camera: the object that is looked
    through, if there is one. border: (x0, y0, x1, y1), the pixels that are wanted, from the lower left."""

    def __init__(self, size, view_matrix, window_matrix, camera=None, border=None):
        self.size = size
        self.view_matrix = view_matrix
        self.window_matrix = window_matrix
        self.camera = camera
        self.border = border

    @classmethod
    def of(cls, context):
        """That of the viewport of a context."""
        region, space, view, render = context.region, context.space_data, context.region_data, context.scene.render
        size = (region.width, region.height)
        camera = space.camera if view.view_perspective == "CAMERA" else None
        found = cls(size, view.view_matrix.copy(), view.window_matrix.copy(), camera)
        if camera is not None and camera.type == "CAMERA" and render.use_border:
            found.border = found.part_of_frame(context.scene)
        elif camera is None and space.use_render_border:
            found.border = _part((0, 0, *size), (space.render_border_min_x, space.render_border_min_y),
                                 (space.render_border_max_x, space.render_border_max_y))
        return found

    def part_of_frame(self, scene):
        """Where the border that the scene renders is in the view [pixels]."""
        points = []
        for corner in self.camera.data.view_frame(scene=scene):
            x, y, _, w = self.window_matrix @ corner.to_4d()
            points.append([(x / w + 1) / 2 * self.size[0], (y / w + 1) / 2 * self.size[1]])
        (x0, y0), (x1, y1) = (tuple(pick(axis) for axis in zip(*points)) for pick in (min, max))
        render = scene.render
        return _part((x0, y0, x1, y1), (render.border_min_x, render.border_min_y), (render.border_max_x, render.border_max_y))

    def crop(self):
        """(x0, y0, x1, y1): the pixels that are wanted, from the upper left; None if no pixel is."""
        width, height = self.size
        x0, y0, x1, y1 = self.border or (0, 0, width, height)
        x0, y0, x1, y1 = max(0, round(x0)), max(0, round(y0)), min(width, round(x1)), min(height, round(y1))
        return (x0, height - y1, x1, height - y0) if x1 > x0 and y1 > y0 else None


def _part(frame, low, high):
    """The part of a frame from (x, y) to (x, y), in shares of its sides."""
    x0, y0, x1, y1 = frame
    return (x0 + (x1 - x0) * low[0], y0 + (y1 - y0) * low[1], x0 + (x1 - x0) * high[0], y0 + (y1 - y0) * high[1])


class Viewport:
    """Follows the dependency graph of a viewport, and its view. `notices` are what candela cannot show."""

    def __init__(self, tell):
        """tell: is called, by another thread, when there is another picture or message."""
        self.accumulator = Accumulator(tell)
        self.notices = Notices()
        self._cache = Cache()
        self._draft = None

    def update(self, depsgraph, session, is_seen=lambda instance: True):
        """Takes over what the dependency graph says has changed."""
        self._cache.begin(depsgraph.updates)
        writer = SceneWriter(depsgraph, session, _SIZE, self._cache)
        self._draft = writer.write_for(_CAMERA, is_seen)._draft
        self._cache.end()
        self.notices = writer.notices
        self.accumulator.follow(session, self._draft)

    def begin_again(self, session):
        """The same scene, by another program."""
        self.accumulator.follow(session, self._draft)

    def look(self, view, depsgraph):
        """Takes over what is to be seen."""
        crop = view.crop()
        if crop is None:
            return
        scene = depsgraph.scene
        settings = scene.candela
        options = {key: value for key, value in settings.options().items() if key not in {"denoise", "target_error"}}
        if scene.render.film_transparent:
            options["background"] = "transparent"
        self.accumulator.look(Look(view.size, crop, view_keys(view, depsgraph, Notices()),
                                   is_outside=view.window_matrix[3][3] != 0 and view.camera is None,
                                   samples=settings.preview_samples, **options))

    def close(self):
        self.accumulator.close()
