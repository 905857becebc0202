"""The reflection models of candela's scenes that Mitsuba 3 lacks, as BSDFs for it, written from the papers.

In Mitsuba's terms, wi points to the viewer and wo to the light, both in the local frame with z along the normal; a
value includes the cosine. Both models are two-sided. Import this module after a variant of Mitsuba has been set.
"""

import drjit as dr
import mitsuba as mi
import numpy as np


class Reflection(mi.BSDF):
    """Two-sided reflection; a model adds value, density and direction at the point si, all on the side of +z."""

    def __init__(self, props):
        super().__init__(props)
        flags = mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide
        self.m_components = [flags]
        self.m_flags = flags

    def eval_pdf(self, context, si, wo, active=True):
        side = dr.sign(si.wi.z)
        wi, wo = mi.Vector3f(si.wi.x, si.wi.y, si.wi.z * side), mi.Vector3f(wo.x, wo.y, wo.z * side)
        active = mi.Bool(active) & (wi.z > 0) & (wo.z > 0)
        return self.value(si, wi, wo) * wo.z & active, dr.select(active, self.density(si, wi, wo), 0)

    def eval(self, context, si, wo, active=True):
        return self.eval_pdf(context, si, wo, active)[0]

    def pdf(self, context, si, wo, active=True):
        return self.eval_pdf(context, si, wo, active)[1]

    def sample(self, context, si, sample1, sample2, active=True):
        side = dr.sign(si.wi.z)
        wi = mi.Vector3f(si.wi.x, si.wi.y, si.wi.z * side)
        wo = self.direction(si, wi, sample1, sample2)
        wo.z *= side
        value, pdf = self.eval_pdf(context, si, wo, active)
        active = mi.Bool(active) & (pdf > 0)
        bs = mi.BSDFSample3f()
        bs.wo = wo
        bs.pdf = dr.select(active, pdf, 0)
        bs.eta = 1.0
        bs.sampled_type = mi.UInt32(+self.m_flags)
        bs.sampled_component = 0
        return bs, dr.select(active, value / pdf, 0)


class Phong(Reflection):
    """kd / pi + ks (n + 2) / (2 pi) cos^n alpha, alpha measured from the mirrored direction.

    Ref: Lafortune and Willems 1994, Using the Modified Phong Reflectance Model for Physically Based Rendering.
    """

    def __init__(self, props):
        super().__init__(props)
        self.kd = mi.Color3f(props["diffuse"])
        self.ks = mi.Color3f(props["specular"])
        self.n = props["exponent"]

    def lobe(self, wi, wo):
        cos_alpha = wi.z * wo.z - wi.x * wo.x - wi.y * wo.y
        return dr.select(cos_alpha > 0, cos_alpha**self.n, 0)

    def value(self, si, wi, wo):
        return self.kd / dr.pi + self.ks * ((self.n + 2) / (2 * dr.pi) * self.lobe(wi, wo))

    def density(self, si, wi, wo):
        return 0.5 * (wo.z / dr.pi + (self.n + 1) / (2 * dr.pi) * self.lobe(wi, wo))

    def direction(self, si, wi, sample1, sample2):
        cos_alpha = sample2.x ** (1 / (self.n + 1))
        sin_alpha = dr.safe_sqrt(1 - cos_alpha * cos_alpha)
        sin_phi, cos_phi = dr.sincos(2 * dr.pi * sample2.y)
        frame = mi.Frame3f(mi.Vector3f(-wi.x, -wi.y, wi.z))
        lobe = frame.to_world(mi.Vector3f(sin_alpha * cos_phi, sin_alpha * sin_phi, cos_alpha))
        return dr.select(sample1 < 0.5, lobe, mi.warp.square_to_cosine_hemisphere(sample2))


class Metal(Reflection):
    """F D G / (4 cos cos): GGX microfacets under a height-correlated G and Schlick's Fresnel term F.

    Mitsuba's own `roughconductor` has another G and another F; D, its sampling and G1 are Mitsuba's.
    Ref: Heitz 2014, Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs, equations 43 and 99;
    Schlick 1994, An Inexpensive BRDF Model for Physically-based Rendering, equation 15.
    """

    def __init__(self, props):
        super().__init__(props)
        self.reflectance = mi.Color3f(props["reflectance"])
        self.alpha = props.get_texture("alpha")

    def facets(self, si):
        return mi.MicrofacetDistribution(mi.MicrofacetType.GGX, self.alpha.eval_1(si))

    def value(self, si, wi, wo):
        h = dr.normalize(wi + wo)
        facets = self.facets(si)
        # Lambda = 1 / G1 - 1 and G = 1 / (1 + Lambda(wi) + Lambda(wo)).
        g = 1 / (1 / facets.smith_g1(wi, h) + 1 / facets.smith_g1(wo, h) - 1)
        fresnel = self.reflectance + (1 - self.reflectance) * (1 - dr.dot(wi, h)) ** 5
        return fresnel * (facets.eval(h) * g / (4 * wi.z * wo.z))

    def density(self, si, wi, wo):
        h = dr.normalize(wi + wo)
        return self.facets(si).pdf(wi, h) / (4 * dr.dot(wi, h))

    def direction(self, si, wi, sample1, sample2):
        h, _ = self.facets(si).sample(wi, sample2)
        return mi.reflect(wi, h)


def phong_value(wi, wo, kd, ks, n):
    """The value for wi (3) and wo (N x 3), without the cosine, in double precision."""
    cos_alpha = wo @ (wi * (-1, -1, 1))
    return kd / np.pi + ks * (n + 2) / (2 * np.pi) * np.where(cos_alpha > 0, abs(cos_alpha) ** n, 0)


def metal_value(wi, wo, reflectance, alpha):
    """The same for the metal; Heitz 2014, equations 71, 72 and 99."""

    def smith_lambda(w):
        return (np.sqrt(1 + alpha**2 * (1 / w[..., 2] ** 2 - 1)) - 1) / 2

    h = wi + wo
    h /= np.linalg.norm(h, axis=1, keepdims=True)
    d = 1 / (np.pi * alpha**2 * (h[:, 2] ** 2 + (1 - h[:, 2] ** 2) / alpha**2) ** 2)
    fresnel = reflectance + (1 - reflectance) * (1 - h @ wi) ** 5
    return fresnel * d / (1 + smith_lambda(wi) + smith_lambda(wo)) / (4 * wi[2] * wo[:, 2])


def quadrature_albedo(value, wi, points=1000):
    """Integral of value(wi, wo) cos over the hemisphere: Gauss and Legendre's rule in z^2, equal steps in longitude."""
    x, weights = np.polynomial.legendre.leggauss(points)
    z = np.sqrt((x + 1) / 2)[:, None]
    phi = 2 * np.pi * np.arange(points) / points
    r = np.sqrt(1 - z**2)
    wo = np.stack([r * np.cos(phi), r * np.sin(phi), z + 0 * phi], axis=-1).reshape(-1, 3)
    return np.pi * np.mean(weights @ value(wi, wo).reshape(points, points)) / 2


def sampled_albedo(bsdf, wi, u, count=1 << 22):
    """Mean weight of the BSDF's samples at texture coordinate u, and its standard error."""
    si = dr.zeros(mi.SurfaceInteraction3f, count)
    si.wi = mi.Vector3f(*wi.tolist())
    si.uv = mi.Point2f(u, 0.5)
    random = mi.PCG32(size=count)
    numbers = [random.next_float32() for _ in range(3)]
    _, weight = bsdf.sample(mi.BSDFContext(), si, numbers[0], mi.Point2f(numbers[1], numbers[2]))
    weight = np.array(weight.x, dtype=float)
    return weight.mean(), weight.std() / np.sqrt(count)


def check_albedos():
    """Raises AssertionError unless the albedos of both BSDFs are those of the formulas by quadrature, at normal
    incidence, obliquely and at a grazing angle: within five standard errors, and 1e-4 for the quadrature."""
    phong = [
        (dict(diffuse=[0.3] * 3, specular=[0.6] * 3, exponent=n), lambda wi, wo, n=n: phong_value(wi, wo, 0.3, 0.6, n))
        for n in (0.0, 10.0, 500.0)
    ]
    # The last is a texture, of which the right half is looked up.
    halves = mi.Bitmap(np.array([[[0.1], [0.4]]], dtype=np.float32))
    texture = {"type": "bitmap", "bitmap": halves, "raw": True, "filter_type": "nearest"}
    metal = [
        (dict(reflectance=[0.6] * 3, alpha=given), lambda wi, wo, a=a: metal_value(wi, wo, 0.6, a))
        for a, given in ((0.1, 0.1), (0.3, 0.3), (0.8, 0.8), (0.4, texture))
    ]
    for kind, cases in (("candela_phong", phong), ("candela_metal", metal)):
        for parameters, value in cases:
            bsdf = mi.load_dict({"type": kind, **parameters})
            for cosine in (1.0, 0.6, 0.15):
                wi = np.array([np.sqrt(1 - cosine**2), 0.0, cosine])
                expected = quadrature_albedo(value, wi)
                mean, error = sampled_albedo(bsdf, wi, 0.75)
                what = f"{parameters} at cosine {cosine}: albedo {mean:.5f} +- {error:.5f}, not {expected:.5f}"
                assert abs(mean - expected) <= 5 * error + 1e-4, f"{kind} {what}"


mi.register_bsdf("candela_phong", Phong)
mi.register_bsdf("candela_metal", Metal)
