"""A texture for Mitsuba's lamps. Import this module after a variant of Mitsuba has been set."""

import mitsuba as mi


class LightTexture(mi.Texture):
    """The nested texture, but points on the lamp are sampled uniformly. Mitsuba would sample them by the texture, and
    so miss those whose coordinates lie beyond 0 to 1."""

    def __init__(self, props):
        super().__init__(props)
        self.texture = props.get_texture("texture")

    def eval(self, si, active=True):
        return self.texture.eval(si, active)

    def is_spatially_varying(self):
        return False


mi.register_texture("candela_light_texture", LightTexture)
