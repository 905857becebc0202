# SPDX-License-Identifier: GPL-3.0-or-later
"""The render engine."""
import time
import warnings
import weakref

import bpy
import numpy

from . import candela
from .axes import to_blender
from .cryptomatte import metadata
from .drawing import Drawing
from .program import session
from .scene_writer import SceneWriter
from .viewport import View, Viewport

# Seconds between two pictures on the way.
_INTERVAL = 1.0
# What Blender takes for infinitely far away.
_FAR = 1e10
# Seconds until a program that has ended in a viewport is started again.
_PATIENCE = 5.0


class _Cancelled(Exception):
    """The user cancelled the rendering."""


class CandelaEngine(bpy.types.RenderEngine):
    bl_idname = "CANDELA"
    bl_label = "candela"
    bl_use_preview = False
    bl_use_shading_nodes_custom = False
    bl_use_eevee_viewport = True
    # Of an engine that shows a viewport.
    viewport = None
    drawing = None
    is_local = False  # Whether the viewport shows some objects only.
    begun = 0.0  # When the program was last asked for.

    def update_render_passes(self, scene=None, renderlayer=None):
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        for name, channels, letters, kind, _ in _passes(renderlayer, scene.candela):
            self.register_pass(scene, renderlayer, name, channels, letters, kind)

    def render(self, depsgraph):
        try:
            self._render(depsgraph)
        except candela.Error as error:
            self.report({"ERROR"}, str(error))
            self.error_set(str(error))

    def _render(self, depsgraph):
        scene = depsgraph.scene
        scale = scene.render.resolution_percentage / 100
        size = (max(int(scene.render.resolution_x * scale), 1), max(int(scene.render.resolution_y * scale), 1))
        crop = _crop(scene.render, size)
        self.update_stats("", "Preparing the scene")
        writer = SceneWriter(depsgraph, session(), size)
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            written = writer.write()
            with written:
                self._accumulate(written, depsgraph.view_layer_eval, scene, crop)
        notices = [*writer.notices, *(str(warning.message) for warning in told)]
        if notices:
            self.report({"WARNING"}, "candela: " + "; ".join(dict.fromkeys(notices)))

    def view_update(self, context, depsgraph):
        if self.viewport is None:
            self.viewport, self.drawing = Viewport(_redraw_of(self)), Drawing()
            weakref.finalize(self, self.viewport.close)
        space = context.space_data
        self.is_local = space.local_view is not None

        def is_seen(instance):
            return (instance.parent or instance.object).original.visible_in_viewport_get(space)
        try:
            self.begun = time.monotonic()
            self.viewport.update(depsgraph, session(), is_seen)
        except candela.Error as error:
            self.viewport.accumulator.say(str(error))

    def view_draw(self, context, depsgraph):
        if self.is_local != (context.space_data.local_view is not None):
            self.view_update(context, depsgraph)  # Blender does not call it.
        view, accumulator = View.of(context), self.viewport.accumulator
        self.viewport.look(view, depsgraph)
        if accumulator.needs_session and time.monotonic() - self.begun > _PATIENCE:
            self._begin_again()
        picture = accumulator.latest
        if picture is not None:
            self.drawing.draw(self, depsgraph.scene, picture, view.size)
        self.update_stats("candela", accumulator.message)

    def _begin_again(self):
        self.begun = time.monotonic()
        try:
            self.viewport.begin_again(session())
        except candela.Error as error:
            self.viewport.accumulator.say(str(error))

    def _accumulate(self, written, view_layer, scene, crop):
        settings = scene.candela
        options = {"crop": crop, "transparent": scene.render.film_transparent, **settings.options()}
        if _mattes(view_layer):
            options["layers"] = ["albedo", "normal", "position", "depth", "object_id", "crypto_object00"]
        samples = settings.samples
        began, goal = time.monotonic(), 1 if not bpy.app.background else samples
        while True:
            goal = min(goal, samples)
            try:
                image = written.render(spp=goal, progress=lambda done: self._tell(done * goal / samples, began), **options)
            except _Cancelled:
                self._show(written.image(options.get("denoise")), view_layer, settings)
                return
            self._show(image, view_layer, settings)
            if goal >= samples or not image.complete or self.test_break():
                return
            goal = _next_goal(goal, time.monotonic() - began)

    def _tell(self, done, began):
        self.update_progress(done)
        self.update_stats("", f"{100 * done:.0f} % after {time.monotonic() - began:.0f} s")
        if self.test_break():
            raise _Cancelled

    def _show(self, image, view_layer, settings):
        result = self.begin_result(0, 0, image.width, image.height, layer=view_layer.name)
        passes = {found.name: found for found in result.layers[0].passes}
        rgb = image.denoised if "denoised" in image.layers else image.rgb
        _fill(passes["Combined"], _with_alpha(rgb, image))
        for name, _, _, _, read in _passes(view_layer, settings):
            if name in passes:
                _fill(passes[name], read(image))
        for kind in _mattes(view_layer):
            names = filter(None, image.names[f"{kind.lower()}_id"])
            for key, value in metadata(f"{view_layer.name}.Crypto{kind}", names):
                result.stamp_data_add_field(key, value)
        self.end_result(result)


def _redraw_of(engine):
    """What makes Blender draw the engine's viewport, as long as there is one; may be called by any thread."""
    engine = weakref.ref(engine)

    def redraw():
        shown = engine()
        if shown is not None:
            try:
                shown.tag_redraw()
            except ReferenceError:
                pass  # Blender has closed it.
    return redraw


def _next_goal(goal, seconds):
    """Twice the samples, or as many as fit into the interval."""
    return goal * 2 if seconds < _INTERVAL else goal + max(1, int(goal * _INTERVAL / seconds))


def _with_alpha(rgb, image):
    return numpy.concatenate([rgb, image.alpha[..., None]], -1)


def _fill(place, pixels):
    """Blender's rows go upwards."""
    place.rect.foreach_set(numpy.ascontiguousarray(pixels[::-1], numpy.float32).reshape(-1))


def _crop(render, size):
    """(x0, y0, x1, y1): what is rendered, from the top left [pixels]."""
    if not render.use_border:
        return 0, 0, *size
    x0, x1 = (int(edge * size[0]) for edge in (render.border_min_x, render.border_max_x))
    y0, y1 = (int(edge * size[1]) for edge in (render.border_min_y, render.border_max_y))
    return x0, size[1] - y1, x1, size[1] - y0


def _passes(layer, settings):
    """(name, number of channels, their letters, kind, values of an image) of each pass that a view layer wants."""
    wanted = []
    if settings.denoise != "none":
        wanted.append(("Noisy Image", 4, "RGBA", "COLOR", lambda image: _with_alpha(image.rgb, image)))
    if layer.use_pass_z:
        wanted.append(("Depth", 1, "Z", "VALUE", lambda image: numpy.minimum(image.depth, _FAR)[..., None]))
    if layer.use_pass_normal:
        wanted.append(("Normal", 3, "XYZ", "VECTOR", lambda image: to_blender(image.normal)))
    if layer.use_pass_position:
        wanted.append(("Position", 3, "XYZ", "VECTOR", lambda image: to_blender(_finite(image.position))))
    if layer.use_pass_diffuse_color:
        wanted.append(("DiffCol", 3, "RGB", "COLOR", lambda image: image.albedo))
    for kind in _mattes(layer):
        for rank in range(3):
            wanted.append((f"Crypto{kind}{rank:02}", 4, "RGBA", "COLOR",
                           lambda image, name=f"crypto_{kind.lower()}{rank:02}": image[name]))
    return wanted


def _mattes(layer):
    """The kinds of Cryptomatte that a view layer wants."""
    return [kind for kind in ("Object", "Material") if getattr(layer, f"use_pass_cryptomatte_{kind.lower()}")]


def _finite(values):
    return numpy.where(numpy.isfinite(values), values, 0.0)


def register():
    bpy.utils.register_class(CandelaEngine)


def unregister():
    bpy.utils.unregister_class(CandelaEngine)
