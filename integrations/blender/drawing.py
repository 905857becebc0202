# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures on the screen, by Blender's module gpu."""
import gpu
from gpu_extras.presets import draw_texture_2d


class Drawing:
    """The latest picture as a texture."""

    def __init__(self):
        self._picture = None
        self._texture = None

    def draw(self, engine, scene, picture, size):
        """Draws a Picture into a viewport of that size [pixels], which shows linear light as the scene's settings say."""
        if self._picture is not picture:
            height, width, channels = picture.pixels.shape
            data = gpu.types.Buffer("FLOAT", width * height * channels, picture.pixels.reshape(-1))
            self._texture = gpu.types.GPUTexture((width, height), format="RGBA16F", data=data)
            self._picture = picture
        x0, y0, x1, y1 = picture.crop
        across, along = size[0] / picture.size[0], size[1] / picture.size[1]  # The viewport may have another size by now.
        gpu.state.blend_set("ALPHA_PREMULT")
        engine.bind_display_space_shader(scene)
        draw_texture_2d(self._texture, (x0 * across, (picture.size[1] - y1) * along), (x1 - x0) * across, (y1 - y0) * along)
        engine.unbind_display_space_shader()
        gpu.state.blend_set("NONE")
