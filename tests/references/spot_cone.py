"""What Mitsuba's spot lights project. Import this module after a variant of Mitsuba has been set."""

import drjit as dr
import mitsuba as mi
import numpy as np


class SpotCone(mi.Texture):
    """The falloff of glTF's KHR_lights_punctual between the angles `inner` and `outer` [degrees], at the coordinates of
    a texture that a light with that cutoff angle projects. (Mitsuba's own falloff is linear in the angle.)"""

    def __init__(self, props):
        super().__init__(props)
        outer = np.radians(props["outer"])
        self.tangent = np.tan(outer)
        self.scale = 1 / (np.cos(np.radians(props["inner"])) - np.cos(outer))
        self.offset = -np.cos(outer) * self.scale

    def eval(self, si, active=True):
        tangents = (2 * si.uv - 1) * self.tangent
        cosine = dr.rsqrt(1 + dr.squared_norm(tangents))
        attenuation = dr.clip(cosine * self.scale + self.offset, 0, 1)
        return mi.Color3f(attenuation * attenuation)

    def is_spatially_varying(self):
        return True


mi.register_texture("candela_spot_cone", SpotCone)
