"""The principled material of candela's scenes as a BSDF for Mitsuba 3, written from docs/scene-format.md and the papers
below, apart from the shaders; without dispersion, sheen, film, rough diffuse base and coat darkening.

Light that microfacets throw at each other is lost by the lobes of single scattering, and returned as diffuse light. Its
share is tabulated here by quadrature.

In Mitsuba's terms, wi points to the viewer and wo to the light, both in the local frame with z along the normal; a
value includes the cosine. Import this module after a variant of Mitsuba has been set.

Ref: Heitz 2014, Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs; Walter et al. 2007, Microfacet
Models for Refraction through Rough Surfaces; Kulla and Conty 2017, Revisiting Physically Based Shading at Imageworks;
Dupuy and Benyoub 2023, Sampling Visible GGX Normals with Spherical Caps.
"""

import drjit as dr
import mitsuba as mi
import numpy as np

MIN_FACET_ALPHA = 1e-3  # Below, facets are mirrors.
MEAN_OF_SCHLICK = 1 / 21  # Mean of (1 - cos)^5 over the cosine-weighted hemisphere.


def alphas(roughness, anisotropy):
    """Along and across the tangent; none of both for mirrors."""
    across = roughness**2
    along = across + (1 - across) * anisotropy**2
    return None if max(along, across) < MIN_FACET_ALPHA else (max(along, MIN_FACET_ALPHA), max(across, MIN_FACET_ALPHA))


def eta_of(ior):
    return float(ior) if ior > 0 else 1e6


def at_normal(eta):
    return ((eta - 1) / (eta + 1)) ** 2


def rise(eta, cosine):
    """(F - f0) / (1 - f0) by Fresnel's equations, of numpy's or drjit's numbers; 1 beyond the critical angle."""
    sine = 1 - cosine**2
    inside = 1 - sine / eta**2
    select, root = (dr.select, dr.sqrt) if isinstance(cosine, mi.Float) else (np.where, np.sqrt)
    maximum = dr.maximum if isinstance(cosine, mi.Float) else np.maximum
    refracted = root(maximum(inside, 0))
    s = (cosine - eta * refracted) / (cosine + eta * refracted)
    p = (eta * cosine - refracted) / (eta * cosine + refracted)
    f0 = at_normal(eta)
    return select(inside > 0, ((s * s + p * p) / 2 - f0) / (1 - f0), 1)


def metal_multiscatter(ax, ay, color):
    """The share of light that comes back of what facets of a metal lose: candela's fit to random walks among them."""
    a = np.sqrt((ax**2 + ay**2) / 2)
    leaves = 1 - 0.397 * a
    fresnel = color + (1 - color) * 0.0378 / (a + 0.0459)
    return fresnel**2 * leaves / (1 - fresnel * (1 - leaves))


# --- Means over the facets that a viewer sees ------------------------------------------------------------------------


def smith_lambda(ax, ay, w):
    reach = np.sqrt(w[..., 2] ** 2 + (ax * w[..., 0]) ** 2 + (ay * w[..., 1]) ** 2)
    return (reach / np.maximum(abs(w[..., 2]), 1e-12) - 1) / 2


def visible_facets(ax, ay, viewer, count):
    """Normals in equal numbers for equal shares of what the viewer sees, by a lattice of Fibonacci's: count x 3."""
    stretch = np.array([ax, ay, 1])
    v = viewer * stretch
    v = v / np.linalg.norm(v)
    phi, u = np.arange(count) * (np.pi * (np.sqrt(5) - 1)), (np.arange(count) + 0.5) / count
    z = 1 - u * (1 + v[2])
    r = np.sqrt(1 - z**2)
    h = (np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1) + v) * stretch
    return h / np.linalg.norm(h, axis=1, keepdims=True)


def facet_means(ax, ay, eta, specular, f0, thin, viewer, count=1 << 14):
    """For facets that reflect specular (f0 + (1 - f0) rise), means of: what leaves the surface if they reflect all; the
    rise; the rise times what leaves; what leaves if the rest is refracted."""
    h = visible_facets(ax, ay, viewer, count)
    cosine = h @ viewer
    t = rise(eta, cosine)
    inside = 1 - (1 - cosine**2) / eta**2
    fresnel = np.where(inside > 0, specular * (f0 + (1 - f0) * t), 1)
    mirrored = 2 * cosine[:, None] * h - viewer
    lambda_viewer = smith_lambda(ax, ay, viewer)
    leaves = (1 + lambda_viewer) / (1 + lambda_viewer + smith_lambda(ax, ay, mirrored))
    leaves = np.where(mirrored[:, 2] > 0, leaves, 0)
    if thin:
        passes = leaves
    else:
        refracted = (cosine / eta - np.sqrt(np.maximum(inside, 0)))[:, None] * h - viewer / eta
        passes = np.where(refracted[:, 2] < 0, 1 / (1 + smith_lambda(ax, ay, refracted)), 0)
    return [np.mean(leaves), np.mean(t), np.mean(t * leaves), np.mean(fresnel * leaves + (1 - fresnel) * passes)]


class Facets:
    """GGX microfacets that the viewer sees across a boundary of index eta; or a mirror without alphas."""

    def __init__(self, alpha, eta, specular=1.0, f0=None, thin=True):
        """f0: of the channel that reflects most."""
        self.alpha, self.eta, self.thin = alpha, eta, thin
        self.specular, self.f0 = specular, at_normal(eta) if f0 is None else f0
        if alpha is None:
            return
        ax, ay = alpha
        columns, rows = 128, 1 if ax == ay else 12
        table = np.empty((rows, columns, 4))
        for row in range(rows):
            phi = np.pi / 2 * (row + 0.5) / rows
            for column in range(columns):
                z = (column + 0.5) / columns
                r = np.sqrt(1 - z * z)
                viewer = np.array([r * np.cos(phi), r * np.sin(phi), z])
                table[row, column] = facet_means(ax, ay, eta, self.specular, self.f0, thin, viewer)
        self.table = mi.Texture2f(mi.TensorXf(table.astype(np.float32)), wrap_mode=dr.WrapMode.Clamp)
        self.ggx = mi.MicrofacetDistribution(mi.MicrofacetType.GGX, ax, ay, True)

    def means(self, wi):
        """See facet_means()."""
        if self.alpha is None:
            return [mi.Float(1), rise(self.eta, wi.z), rise(self.eta, wi.z), mi.Float(1)]
        phi = dr.atan2(abs(wi.y), abs(wi.x))
        return self.table.eval(mi.Point2f(wi.z, phi * (2 / dr.pi)))

    def shadowing(self, wi, wo, h):
        """Of both sides at once for reflection, of each on its own for refraction."""
        from_viewer, from_light = self.ggx.smith_g1(wi, h), self.ggx.smith_g1(wo, h)
        if not self.thin:
            from_light = self.ggx.smith_g1(mi.Vector3f(wo.x, wo.y, abs(wo.z)), mi.Vector3f(0, 0, 1))
        return dr.select(wo.z > 0, 1 / (1 / from_viewer + 1 / from_light - 1), from_viewer * from_light)


# --- The material ----------------------------------------------------------------------------------------------------


def literal(color):
    """Without memory of its own, which must not be allocated while Mitsuba records a kernel."""
    return mi.Color3f(*(float(c) for c in color))


def upwards(w):
    return mi.Vector3f(w.x, w.y, abs(w.z))


class Principled(mi.BSDF):
    """Lobes: 0 coat, 1 facets of the base, which reflect or transmit, 2 diffuse reflection, 3 diffuse transmission."""

    def __init__(self, props):
        super().__init__(props)
        number = lambda name, default: float(props.get(name, default))  # noqa: E731
        color = lambda name: np.array(mi.ScalarColor3f(props.get(name, mi.ScalarColor3f(1))))  # noqa: E731
        self.base, self.metalness = color("base_color"), number("metalness", 0)
        self.ior, self.specular = eta_of(number("ior", 1.5)), number("specular", 1)
        self.specular_color = color("specular_color")
        self.transmission, self.thin = number("transmission", 0), bool(props.get("thin_walled", True))
        self.diffuse_transmission = number("diffuse_transmission", 0)
        self.diffuse_transmission_color = color("diffuse_transmission_color")
        self.coat = number("coat", 0)
        self.turn = float(np.radians(number("anisotropy_rotation", 0)))

        alpha = alphas(number("roughness", 0.5), number("anisotropy", 0))
        f0 = at_normal(self.ior)
        self.f0 = np.minimum(f0 * self.specular_color, 1)
        facets = lambda eta: Facets(alpha, eta, self.specular, self.f0.max(), self.thin)  # noqa: E731
        self.outside = facets(self.ior)
        self.inside = self.outside if self.thin else facets(1 / self.ior)
        self.coat_facets = Facets(alphas(number("coat_roughness", 0), 0), eta_of(number("coat_ior", 1.5)))
        self.ideal, self.ideal_coat = alpha is None, self.coat_facets.alpha is None

        self.metal_lost = np.zeros(3) if self.ideal else metal_multiscatter(*alpha, self.base)
        mean_fresnel = f0 + (1 - f0) * MEAN_OF_SCHLICK
        self.up_outside = mean_fresnel
        self.up_inside = mean_fresnel if self.thin else 1 - (1 - mean_fresnel) / self.ior**2

        flags = mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide | mi.BSDFFlags.Anisotropic
        flags |= mi.BSDFFlags.DiffuseReflection | mi.BSDFFlags.DiffuseTransmission
        flags |= mi.BSDFFlags.DeltaReflection if self.ideal or self.ideal_coat else mi.BSDFFlags.GlossyReflection
        if self.transmission > 0:
            flags |= mi.BSDFFlags.DeltaTransmission if self.ideal else mi.BSDFFlags.GlossyTransmission
        self.m_components = [flags]
        self.m_flags = flags

    # The viewer's side. Mitsuba's frame has its tangent along u; ours is turned from there.

    def frame(self, si):
        """Sine and cosine of the tangent's angle."""
        u = si.to_local(si.dp_du)
        return dr.sincos(dr.select(dr.squared_norm(si.dp_du) > 0, dr.atan2(u.y, u.x), 0) + self.turn)

    def to_own(self, si, w):
        s, c = self.frame(si)
        return mi.Vector3f(c * w.x + s * w.y, c * w.y - s * w.x, w.z * dr.sign(si.wi.z))

    def from_own(self, si, w):
        s, c = self.frame(si)
        return mi.Vector3f(c * w.x - s * w.y, s * w.x + c * w.y, w.z * dr.sign(si.wi.z))

    def parts(self, si, wi):
        """What does not depend on the light: a dictionary."""
        enters = (si.wi.z > 0) | self.thin
        means = [dr.select(enters, a, b) for a, b in zip(self.outside.means(wi), self.inside.means(wi))]
        leaves, t, t_leaves, returned = means
        m, s, top = self.metalness, self.specular, float(self.f0.max())
        fresnel = s * (top + (1 - top) * t)
        lost = s * (top * (1 - leaves) + (1 - top) * (t - t_leaves))
        opaque, glass = (1 - m) * (1 - self.transmission), (1 - m) * self.transmission
        up_fraction = dr.select(enters, self.up_outside, self.up_inside)
        eta = dr.select(enters, self.ior, 1 / self.ior)
        spread = mi.Float(1) if self.thin else 1 / (eta * eta)  # Of radiance that is transmitted.

        coat = self.coat_facets.means(wi)
        coat_f0 = self.coat_facets.f0
        coat_fraction = dr.select(enters, self.coat * (coat_f0 * coat[0] + (1 - coat_f0) * coat[2]), 0)
        below = 1 - coat_fraction

        white = s * self.f0  # What the dielectric reflects of what its facets lose.
        diffuse = opaque * (1 - fresnel + lost * (1 - float(white.max())))
        up = m * literal(self.metal_lost) * (1 - leaves) + opaque * lost * literal(white)
        up += glass * (1 - returned) * up_fraction + diffuse * (1 - self.diffuse_transmission) * literal(self.base)
        down = glass * (1 - returned) * (1 - up_fraction) * literal(self.base)
        down += diffuse * self.diffuse_transmission * literal(self.diffuse_transmission_color)
        up, down = below * up, below * spread * down

        facets = below * (m + opaque * fresnel + glass)
        weights = [coat_fraction, facets, dr.max(up), dr.max(down)]
        total = weights[0] + weights[1] + weights[2] + weights[3]
        pmf = [w / total for w in weights]
        return {"eta": eta, "spread": spread, "below": below, "enters": enters, "up": up, "down": down, "pmf": pmf}

    def reflectance(self, parts, cosine):
        """Of a facet of the base: what it reflects, per colour, and the part that it transmits but for the colour."""
        t = rise(parts["eta"], cosine)
        total = 1 - (1 - cosine * cosine) / (parts["eta"] * parts["eta"]) <= 0
        dielectric = lambda f0: self.specular * (f0 + (1 - f0) * t)  # noqa: E731
        clear = lambda f0: dr.select(total, 1, dielectric(f0))  # noqa: E731
        schlick = literal(self.base) + literal(1 - self.base) * (1 - cosine) ** 5
        m, fraction = self.metalness, self.transmission
        f0 = literal(self.f0)
        reflected = m * schlick + (1 - m) * ((1 - fraction) * dielectric(f0) + fraction * clear(f0))
        return reflected, (1 - m) * fraction * (1 - clear(float(self.f0.max())))

    def chance_to_transmit(self, parts, cosine):
        """Probability that a sampled facet of the base transmits."""
        reflected, transmitted = self.reflectance(parts, cosine)
        return transmitted / dr.maximum(dr.mean(reflected) + transmitted, 1e-9)

    def eval_pdf(self, context, si, wo, active=True):
        wi, wo = self.to_own(si, si.wi), self.to_own(si, wo)
        parts = self.parts(si, wi)
        reflects = wo.z > 0
        cosine = abs(wo.z) / dr.pi
        value = dr.select(reflects, parts["up"], parts["down"]) * cosine
        pdf = dr.select(reflects, parts["pmf"][2], parts["pmf"][3]) * cosine
        if not self.ideal:
            v, p = self.base_facets(parts, wi, wo)
            value, pdf = value + parts["below"] * v, pdf + parts["pmf"][1] * p
        if self.coat > 0 and not self.ideal_coat:
            h = dr.normalize(wi + wo)
            facets = self.coat_facets
            c = dr.dot(wi, h)
            shows = reflects & parts["enters"]
            fresnel = facets.f0 + (1 - facets.f0) * rise(mi.Float(facets.eta), c)
            v = self.coat * fresnel * facets.ggx.eval(h) * facets.shadowing(wi, wo, h) / (4 * wi.z)
            value += dr.select(shows, v, 0)
            pdf += dr.select(shows, parts["pmf"][0] * facets.ggx.pdf(wi, h) / (4 * c), 0)
        active = mi.Bool(active) & (wi.z > 0) & (wo.z != 0)
        return value & active, dr.select(active, pdf, 0)

    def base_facets(self, parts, wi, wo):
        """Value with cosine, and density, of the facets of the base."""
        facets, eta, reflects = self.outside, parts["eta"], wo.z > 0
        if self.thin:  # Transmits what it would reflect, mirrored.
            mirrored = upwards(wo)
            h = dr.normalize(wi + mirrored)
            c = dr.dot(wi, h)
            jacobian = 1 / (4 * c)
            fraction, transmitted = facets.ggx.eval(h) * facets.shadowing(wi, mirrored, h) / (4 * wi.z), jacobian
            allowed = mi.Bool(True)
        else:
            h = dr.normalize(dr.select(reflects, wi + wo, wi + eta * wo))
            h *= dr.sign(h.z)
            c, c_light = dr.dot(wi, h), dr.dot(wo, h)
            allowed = (c > 0) & dr.select(reflects, c_light > 0, c_light < 0)
            denominator = (c + eta * c_light) ** 2
            jacobian = dr.select(reflects, 1 / (4 * c), eta * eta * abs(c_light) / denominator)
            # Walter's equation 21 for radiance; its index of refraction is that of the viewer's side.
            fraction = facets.ggx.eval(h) * facets.shadowing(wi, wo, h)
            fraction *= dr.select(reflects, 1 / (4 * wi.z), c * abs(c_light) / (wi.z * denominator))
        reflected, transmitted = self.reflectance(parts, c)
        down = self.chance_to_transmit(parts, c)
        value = dr.select(reflects, reflected, transmitted * literal(self.base)) * fraction
        pdf = facets.ggx.pdf(wi, h) * jacobian * dr.select(reflects, 1 - down, down)
        return value & allowed, dr.select(allowed, pdf, 0)

    def eval(self, context, si, wo, active=True):
        return self.eval_pdf(context, si, wo, active)[0]

    def pdf(self, context, si, wo, active=True):
        return self.eval_pdf(context, si, wo, active)[1]

    def sample(self, context, si, sample1, sample2, active=True):
        wi = self.to_own(si, si.wi)
        parts = self.parts(si, wi)
        pmf, eta = parts["pmf"], parts["eta"]
        coat = sample1 < pmf[0]
        facets = ~coat & (sample1 < pmf[0] + pmf[1])
        down = sample1 >= pmf[0] + pmf[1] + pmf[2]
        mirror = (coat & self.ideal_coat) | (facets & self.ideal)

        h = mi.Normal3f(0, 0, 1)
        for chosen, which in ((facets, self.outside), (coat, self.coat_facets)):
            if which.alpha is not None:
                h = dr.select(chosen, which.ggx.sample(wi, sample2)[0], h)
        c = dr.dot(wi, h)
        reflected, transmitted = self.reflectance(parts, c)
        p_down = self.chance_to_transmit(parts, c)
        passes = facets & ((sample1 - pmf[0]) / pmf[1] < p_down)
        refracted = (c / eta - dr.safe_sqrt(1 - (1 - c * c) / (eta * eta))) * h - wi / eta
        off = mi.reflect(wi, h)
        through = mi.Vector3f(off.x, off.y, -off.z) if self.thin else refracted
        diffuse = mi.warp.square_to_cosine_hemisphere(sample2)
        diffuse.z = dr.select(down, -diffuse.z, diffuse.z)
        wo = dr.select(coat | facets, dr.select(passes, through, off), diffuse)
        wo = self.from_own(si, wo)

        value, pdf = self.eval_pdf(context, si, wo, active)
        weight = dr.select(pdf > 0, value / pdf, 0)
        # Mirrors: value and density over that of the direction.
        own = dr.select(passes, transmitted * parts["spread"] * literal(self.base), reflected) * parts["below"]
        coat_c = self.coat_facets.f0 + (1 - self.coat_facets.f0) * rise(mi.Float(self.coat_facets.eta), c)
        p_mirror = dr.select(coat, pmf[0], pmf[1] * dr.select(passes, p_down, 1 - p_down))
        v_mirror = dr.select(coat, self.coat * coat_c, own)
        pdf = dr.select(mirror, p_mirror, pdf)
        weight = dr.select(mirror, v_mirror / p_mirror, weight)

        # Rough facets may reflect to below the surface.
        lost = (coat | (facets & ~passes)) & (wo.z * si.wi.z <= 0)
        lost |= passes & (wo.z * si.wi.z >= 0)
        active = mi.Bool(active) & (wi.z > 0) & (pdf > 0) & ~lost
        bs = mi.BSDFSample3f()
        bs.wo = wo
        bs.pdf = dr.select(active, pdf, 0)
        bs.eta = dr.select((wo.z * si.wi.z < 0) & (not self.thin), eta, 1)
        above, below = mi.BSDFFlags.DeltaReflection, mi.BSDFFlags.DeltaTransmission
        delta = dr.select(passes, mi.UInt32(+below), mi.UInt32(+above))
        glossy_above, glossy_below = mi.BSDFFlags.GlossyReflection, mi.BSDFFlags.GlossyTransmission
        rough = dr.select(wo.z * si.wi.z < 0, mi.UInt32(+glossy_below), mi.UInt32(+glossy_above))
        bs.sampled_type = dr.select(mirror, delta, rough)
        bs.sampled_component = 0
        return bs, weight & active


def sampled_energy(bsdf, cosine, count=1 << 20):
    """Mean share of light that the BSDF's samples return to either side, undoing what refraction does to radiance; and
    its standard error."""
    si = dr.zeros(mi.SurfaceInteraction3f, count)
    sine = float(np.sqrt(1 - cosine**2))
    si.wi = mi.Vector3f(0.8 * sine, 0.6 * sine, cosine)
    si.sh_frame = mi.Frame3f(mi.Vector3f(1, 0, 0), mi.Vector3f(0, 1, 0), mi.Vector3f(0, 0, 1))
    si.dp_du = mi.Vector3f(1, 0, 0)
    random = mi.PCG32(size=count)
    numbers = [random.next_float32() for _ in range(3)]
    sample, weight = bsdf.sample(mi.BSDFContext(), si, numbers[0], mi.Point2f(numbers[1], numbers[2]))
    fraction = np.array(weight.x * sample.eta * sample.eta, dtype=float)
    return fraction.mean(), fraction.std() / np.sqrt(count)


def check_energy():
    """Raises AssertionError unless white materials return all light, for any layers, within five standard errors
    and 5e-4 for the tables."""
    solid = {"thin_walled": False}
    cases = [
        {"metalness": 1.0, "roughness": 0.6, "anisotropy": 0.6, "anisotropy_rotation": 20.0},
        {"metalness": 0.5, "roughness": 0.0},
        {"roughness": 0.5, "ior": 1.8, "specular": 0.7, "diffuse_transmission": 0.4},
        {"roughness": 0.6, "transmission": 0.7},
        {"roughness": 0.0, "transmission": 0.7, **solid},
        {"roughness": 0.5, "transmission": 0.7, **solid},
        {"roughness": 0.4, "anisotropy": 0.7, "transmission": 1.0, "ior": 1.8, **solid},
        {"roughness": 0.4, "coat": 0.8},
        {"roughness": 0.3, "metalness": 0.5, "coat": 1.0, "coat_roughness": 0.6, "coat_ior": 1.7},
    ]
    for case in cases:
        bsdf = mi.load_dict({"type": "candela_principled", "base_color": mi.ScalarColor3f(1), **case})
        for cosine in (1.0, 0.6, 0.15, -0.6):
            mean, error = sampled_energy(bsdf, cosine)
            assert abs(mean - 1) <= 5 * error + 5e-4, f"{case} at cosine {cosine}: returns {mean:.5f} +- {error:.5f}"


mi.register_bsdf("candela_principled", Principled)
