#!/usr/bin/env python3
"""Computes the albedos of rough lobes by quadrature, fits them, and writes albedo.glsl beside this file.

usage: fit_albedos.py            Fits and writes; some minutes on two cores.
       fit_albedos.py --check    Reads albedo.glsl, evaluates it in 32-bit floats against the quadrature on other points
                                 than those of the fit, prints the worst ratios; exits 1 if a bound is broken.
Needs Python 3.9, numpy and scipy. Set OMP_NUM_THREADS=1 where other work runs.

The albedos are of one scattering by facets with the GGX distribution, under a uniform sky; D_o is the density of the
normals that wo sees, G1 Smith's masking, G2 the height-correlated masking and shadowing:
    A   reflection by facets that reflect all           integral of D_o G2/G1(o)
    B   reflection by facets that reflect t             t = (F - f0) / (1 - f0), F Fresnel's exact reflectance
    E   a clear dielectric                              F G2/G1(o) + (1 - F) G1(i), i the refracted direction
    E0  the same with F = 0 but beyond the critical angle
    Es  the Charlie lobe of KHR_materials_sheen
eta is the index behind the surface over that before it.

Ref: Walter et al. 2007, Microfacet Models for Refraction through Rough Surfaces; Heitz 2014, Understanding the
Masking-Shadowing Function in Microfacet-Based BRDFs; Heitz 2018, Sampling the GGX Distribution of Visible Normals;
Dupuy and Benyoub 2023, Sampling Visible GGX Normals with Spherical Caps; Turquin 2019, Practical multiple scattering
compensation for microfacet models; Conty and Kulla 2017, Production Friendly Microfacet Sheen BRDF.
"""
import itertools
import re
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from scipy.interpolate import RectBivariateSpline
from scipy.optimize import least_squares, linprog

FILE = Path(__file__).with_name("albedo.glsl")
LEAST_ALPHA, LEAST_SHEEN = 1e-3, 0.07**2
NEAR = 1.05  # Below this ratio of indices, and above its inverse, networks of their own.
LOW = 0.9996  # A fit below this share of the albedo would create energy.

# ---- Quadrature ----------------------------------------------------------------------------------------------------


def legendre(n):
    """Nodes and weights of Gauss on [0, 1], denser at both ends, so that square roots there do not matter."""
    x, w = np.polynomial.legendre.leggauss(n)
    x, w = 0.5 * (x + 1), 0.5 * w
    return x * x * (3 - 2 * x), w * 6 * x * (1 - x)


def fresnel(cos_o, eta):
    """Reflectance and cosine of refraction, 1 and 0 beyond the critical angle."""
    square = 1 - (1 - cos_o**2) / eta**2
    cos_t = np.sqrt(np.maximum(square, 0))
    with np.errstate(all="ignore"):
        parallel = (eta * cos_o - cos_t) / (eta * cos_o + cos_t)
        perpendicular = (cos_o - eta * cos_t) / (cos_o + eta * cos_t)
    return np.where(square <= 0, 1, 0.5 * (parallel**2 + perpendicular**2)), cos_t


def roots(a, b, c):
    """Of a x^2 + 2 b x + c; nan where there are none."""
    with np.errstate(all="ignore"):
        q = -(b + np.where(b >= 0, 1, -1) * np.sqrt(b * b - a * c))
        return q / a, c / q


def albedos(alpha, c, eta, n_theta=16, n=16):
    """A, B, E and E0, an array [4, m], for arrays [m]. 1e-5 near; E and E0 for eta < 1 need twice the nodes."""
    out = np.empty((4, len(alpha)))
    step = max(1, 130000 // (n_theta * 8 * n))
    for i in range(0, len(alpha), step):
        s = slice(i, i + step)
        out[:, s] = albedos_chunk(alpha[s], c[s], eta[s], n_theta, n)
    return out


def albedos_chunk(alpha, c, eta, n_theta, n):
    # The facet's normal in the space where alpha is 1: (cos(theta) sin(chi), sin(theta), cos(theta) cos(chi)), the
    # viewer in the plane theta = 0; its density there is cos(theta)^2 cos(angle to wo). On a line of constant theta,
    # with p the normal's slope in that plane, wi on the horizon and the critical angle are roots of quadratics in p, and
    # so are the theta where such roots appear. The intervals between them are smooth.
    a, c, e = (np.asarray(v, float)[:, None] for v in (alpha, c, eta))
    s = np.sqrt((1 - c) * (1 + c))
    k2 = np.where(e < 1, 1 - e * e, np.nan)
    with np.errstate(all="ignore"):
        tan2 = [np.fmax(*roots(c * a**2, -0.5 * c * (1 - a**2), -1 / c)),
                np.fmax(*roots(k2 * a**2, -0.5 * (c**2 - k2 + a**2 * (s**2 - k2)), k2 - 1))]
    cut = np.sort(np.concatenate([0 * c] + [np.arctan(np.sqrt(np.nan_to_num(t))) for t in tan2] + [0 * c + np.pi / 2],
                                 1), 1)
    x, wx = legendre(n_theta)
    span = np.diff(cut, axis=1)[:, :, None]
    theta, w_theta = ((y.reshape(len(c), -1)) for y in (cut[:, :-1, None] + span * x, span * wx))
    tan = np.tan(theta)
    first = -np.arctan2(c, s * a) + 0 * tan
    slopes = (*roots(c * (1 + tan**2), -s + 0 * tan, c * (tan**2 * a * a - 1)),
              *roots(s**2 - k2 * (1 + tan**2), s * c + 0 * tan, c**2 - k2 * (1 + tan**2 * a * a)),
              np.sqrt(a) + 0 * tan, 0.25 * s / c + 0 * tan)
    edges = [np.arctan(p / a) for p in slopes]
    edges = [np.where(np.isnan(p), first, np.clip(p, first, np.pi / 2)) for p in edges]
    edges = np.sort(np.stack([first, *edges, 0 * first + np.pi / 2], -1), -1)
    y, wy = legendre(n)
    width = np.diff(edges, axis=-1)[..., None]
    chi = edges[..., :-1, None] + width * y
    a, c, e, s = (v[:, :, None, None] for v in (a, c, e, s))
    sin_chi, cos_chi = np.sin(chi), np.cos(chi)
    cos_th, sin_th, w_theta = (v[:, :, None, None] for v in (np.cos(theta), np.sin(theta), w_theta))
    reach = np.sqrt(c**2 + (a * s)**2)
    weight = cos_th**2 * np.maximum(a * s * sin_chi + c * cos_chi, 0) / reach * w_theta * width * wy
    weight *= 4 / (np.pi * (1 + c / reach))
    hx, hy, hz = a * cos_th * sin_chi, a * sin_th, cos_th * cos_chi
    inverse = 1 / np.sqrt(hx * hx + hy * hy + hz * hz)
    hz = hz * inverse
    oh = np.maximum((s * hx + c * cos_th * cos_chi) * inverse, 0)
    f, cos_t = fresnel(oh, e)
    z = np.maximum(2 * oh * hz - c, 0)
    g_r = z * (c + reach) / (z * reach + c * np.sqrt(z**2 + a * a * np.maximum(1 - z * z, 0)))
    z = np.maximum(c / e - (oh / e - cos_t) * hz, 0)
    g_t = 2 * z / (z + np.sqrt(z**2 + a * a * np.maximum(1 - z * z, 0)) + 1e-300)
    total = (e < 1) & (oh * oh <= 1 - e * e)
    f0 = ((e - 1) / (e + 1))**2
    t = np.where(total, 1, np.where(e == 1, 0, (f - f0) / (1 - f0)))
    f = np.where(total, 1, np.where(e == 1, 0, f))
    mean = lambda v: (v * weight).sum((1, 2, 3))
    return mean(g_r), mean(t * g_r), mean(f * g_r + (1 - f) * g_t), mean(np.where(total, g_r, g_t))


def albedos_anisotropic(ax, ay, phi, c, eta, n=64):
    """A and E, [2, m], for wo at the azimuth phi; 1e-3 near."""
    g, wg = legendre(n)
    out = []
    for ax, ay, phi, c, e in zip(ax, ay, phi, c, eta):
        s = np.sqrt(1 - c * c)
        o = np.array([s * np.cos(phi), s * np.sin(phi), c])
        std = o * [ax, ay, 1]
        reach = np.linalg.norm(std)
        std /= reach
        side = np.hypot(std[0], std[1])
        cp, sp = (std[0] / side, std[1] / side) if side > 1e-12 else (1, 0)
        theta = np.concatenate([-g[::-1], g])[:, None] * np.pi / 2
        w_theta = np.concatenate([wg[::-1], wg])[:, None] * np.pi / 2
        first = np.arctan2(side, std[2]) - np.pi / 2
        half = 0.5 * (np.pi / 2 - first)
        chi = np.concatenate([first + half * g, first + half + half * g])
        x, y, z = np.cos(theta) * np.sin(chi), np.sin(theta) + 0 * chi, np.cos(theta) * np.cos(chi)
        w = np.cos(theta) * np.maximum(x * side + z * std[2], 0) * w_theta * np.concatenate([wg, wg]) * half
        h = np.stack([ax * (x * cp - y * sp), ay * (x * sp + y * cp), z])
        h /= np.sqrt((h**2).sum(0))
        oh = np.maximum(np.tensordot(o, h, 1), 0)
        f, cos_t = fresnel(oh, e)
        reach_of = lambda i: np.sqrt(i[2]**2 + (ax * i[0])**2 + (ay * i[1])**2)
        i = 2 * oh * h - o[:, None, None]
        zi = np.maximum(i[2], 0)
        g_r = zi * (c + reach) / (zi * reach + c * reach_of(i))
        i = -o[:, None, None] / e + (oh / e - cos_t) * h
        zi = np.where(f >= 1, 0, np.maximum(-i[2], 0))
        g_t = 2 * zi / (zi + reach_of(i) + 1e-300)
        w = w * 2 / (np.pi * (1 + std[2]))
        out.append(((w * g_r).sum(), (w * (f * g_r + (1 - f) * g_t)).sum()))
    return np.array(out).T


def sheen_albedos(alpha, c, n=64, m=48):
    """Es for arrays [m]."""
    x, w = np.polynomial.legendre.leggauss(n)
    z, w_z = (0.5 * (x + 1))**3, 1.5 * w * (0.5 * (x + 1))**2
    y, w = np.polynomial.legendre.leggauss(m)
    phi, w_phi = np.pi * (1 - (0.5 * (1 - y))**3), 1.5 * np.pi * w * (0.5 * (1 - y))**2

    def lambda_sheen(cos, a):
        t = (1 - a)**2
        p = [u + (v - u) * t for u, v in ((21.5473, 25.3245), (3.82987, 3.32435), (0.19823, 0.16801),
                                          (-1.97760, -1.27393), (-4.32054, -4.85967))]
        l = lambda x: p[0] / (1 + p[1] * x**p[2]) + p[3] * x + p[4]
        return np.where(cos < 0.5, np.exp(l(np.minimum(cos, 0.5))), np.exp(2 * l(0.5) - l(1 - np.maximum(cos, 0.5))))

    out = []
    for a, c in zip(alpha, c):
        length2 = 2 + 2 * (c * z[:, None] + np.sqrt((1 - c * c) * (1 - z * z))[:, None] * np.cos(phi))
        cos2 = np.minimum((c + z)[:, None]**2 / length2, 1 - 1e-16)
        d = (2 + 1 / a) / (2 * np.pi) * np.exp(0.5 / a * np.log1p(-cos2))
        out.append(2 * ((d @ w_phi) * w_z / (4 * c * (1 + lambda_sheen(c, a) + lambda_sheen(z, a)))).sum())
    return np.array(out)


# ---- GLSL to Python, so that what is fitted and checked is the text of the shader -------------------------------------


def translate(text):
    """Functions of straight-line GLSL -> {name: Python function of numpy arrays}; their precision is the arrays'."""
    def vec4(*v):
        return np.stack(np.broadcast_arrays(*v)).reshape(4, -1) if len(v) == 4 else v[0]

    names = {"sqrt": np.sqrt, "abs": np.abs, "min": np.minimum, "max": np.maximum, "clamp": np.clip,
             "square": lambda x: x * x, "where": np.where, "dot": lambda a, b: (a * b).sum(0),
             "mix": lambda a, b, t: a + (b - a) * t, "__builtins__": {}}
    literal = lambda *v: np.array(v)[:, None]
    names["literal4"] = literal
    names["vec4"] = vec4
    names["fresnel_dielectric_exact"] = lambda c, t, e: 0.5 * (((e * c - t) / (e * c + t))**2
                                                              + ((c - e * t) / (c + e * t))**2)
    text = re.sub(r"//.*", "", text)
    code = []
    for head, arguments, body in re.findall(r"(?:float|vec4) (\w+)\(([^)]*)\) \{(.*?)\n\}", text, re.S):
        code.append("def %s(%s):" % (head, ", ".join(a.split()[-1] for a in arguments.split(","))))
        for line in " ".join(body.split()).split(";"):
            line = re.sub(r"^\s*(float|vec4) ", "", line).strip()
            choice = re.match(r"(return |\w+ = )(.*) \? (.*) : (.*)$", line)
            if choice:
                line = "%swhere(%s, %s, %s)" % choice.groups()
            code.append("    " + line)
    source = "\n".join(code)
    number = r"-?[0-9.]+(?:e-?[0-9]+)?"
    source = re.sub(r"vec4\((%s(?:, %s){3})\)" % (number, number), r"literal4(\1)", source)
    exec(source, names)
    return names


def single(functions):
    """The same functions in 32-bit floats."""
    literal = functions["literal4"]
    functions["literal4"] = lambda *v: literal(*v).astype(np.float32)
    return functions

# ---- Fits ----------------------------------------------------------------------------------------------------------


def minimax(columns, f, tolerance):
    """x with the least d such that |columns x - f| <= d tolerance, by linear programmes over growing sets of rows."""
    q, r = np.linalg.qr(columns / tolerance[:, None])
    q, r, goal = q * np.sqrt(len(f)), r / np.sqrt(len(f)), f / tolerance
    n = columns.shape[1]
    rows = np.unique(np.linspace(0, len(f) - 1, 6 * n).astype(int))
    for _ in range(40):
        a, one = q[rows], np.ones((len(rows), 1))
        x = linprog(np.append(np.zeros(n), 1), A_ub=np.block([[a, -one], [-a, -one]]),
                    b_ub=np.append(goal[rows], -goal[rows]), bounds=(None, None)).x
        error = np.abs(q @ x[:-1] - goal)
        worst = np.argsort(-error)[:3 * n]
        worst = worst[error[worst] > x[-1] * 1.003]
        if len(worst) == 0:
            break
        rows = np.union1d(rows, worst)
    return np.linalg.solve(r, x[:-1])


def fit_polynomial(x, y, f, degrees, total, size):
    """{(i, j): coefficient of x^i y^j}, relative minimax, of the `size` terms that matter most."""
    terms = [t for t in itertools.product(*(range(d + 1) for d in degrees)) if sum(t) <= total]
    columns = np.stack([x**i * y**j for i, j in terms], 1)
    m = columns / f[:, None]
    scale = np.sqrt((m**2).sum(0))
    m /= scale
    gram, b, keep = m.T @ m, m.sum(0), list(range(len(terms)))
    while len(keep) > size:
        inverse = np.linalg.inv(gram[np.ix_(keep, keep)] + 1e-13 * np.eye(len(keep)))
        del keep[np.argmin((inverse @ b[keep])**2 / np.diag(inverse))]
    return dict(zip([terms[k] for k in keep], minimax(columns[:, keep], f, f)))


def forward(th, x, n):
    d = x.shape[1]
    a = x @ th[:n * d].reshape(n, d).T
    q = 1 / np.sqrt(1 + a * a)
    return th[n * d] + (a * q) @ th[n * d + 1:], a * q, q


def descend(th, x, base, goal, n, steps, ridge, reweigh):
    """Levenberg and Marquardt's steps; reweighing by the errors (Lawson) turns least squares into minimax."""
    m, d = x.shape
    size, weight, damping, best = len(th), np.ones(m), 1e-2, (1e9, th)

    def cost_of(th):
        r = base * forward(th, x, n)[0] - goal
        return r, (weight * r * r).mean() + ridge * (th * th).sum() / size

    r, cost = cost_of(th)
    for it in range(steps):
        _, s, q = forward(th, x, n)
        jacobian = np.concatenate([((q**3 * th[n * d + 1:])[:, :, None] * x[:, None, :]).reshape(m, -1),
                                   np.ones((m, 1)), s], 1)
        root = np.sqrt(weight / m)
        jacobian *= (base * root)[:, None]
        gram = jacobian.T @ jacobian + ridge / size * np.eye(size)
        slope = jacobian.T @ (r * root) + ridge * th / size
        for _ in range(10):
            new = th - np.linalg.solve(gram + damping * np.diag(np.diag(gram)), slope)
            new_r, new_cost = cost_of(new)
            if new_cost < cost:
                th, r, cost, damping = new, new_r, new_cost, max(damping * 0.3, 1e-8)
                break
            damping *= 4
        else:
            damping = 1e-2
        error = np.abs(r)
        if error.max() < best[0]:
            best = (error.max(), th)
        if reweigh and it % 5 == 4:
            weight = weight * (error / error.max() + 0.03)**0.7
            weight = np.clip(weight / weight.mean(), 0.02, 300)
            cost = cost_of(th)[1]
    return th, cost, best


def fit_network(x, base, goal, tolerance, n, steps=(40, 300, 500), tries=6):
    """(W [n, inputs + 1], v [n + 1]) of v0 + sum v_k bend(W_k (1, x)): base times it is near the goal."""
    rng = np.random.default_rng(0)
    m, d = len(goal), x.shape[1] + 1
    mean, deviation = x.mean(0), x.std(0)
    x1 = np.concatenate([np.ones((m, 1)), (x - mean) / deviation], 1)
    base, goal = base / tolerance, goal / tolerance
    starts = []
    for _ in range(tries):
        th = np.concatenate([rng.normal(size=n * d) * 0.7, np.zeros(n + 1)])
        columns = np.concatenate([np.ones((m, 1)), forward(th, x1, n)[1]], 1) * base[:, None]
        th[n * d:] = np.linalg.solve(columns.T @ columns + 1e-3 * m * np.eye(n + 1), columns.T @ goal)
        starts.append(descend(th, x1, base, goal, n, steps[0], 1e-3, False))
    th, _, first = descend(min(starts, key=lambda s: s[1])[0], x1, base, goal, n, steps[1], 1e-4, False)
    error, th = min(first, descend(th, x1, base, goal, n, steps[2], 1e-4, True)[2], key=lambda b: b[0])
    w = th[:n * d].reshape(n, d).copy()
    w[:, 1:] /= deviation
    w[:, 0] -= w[:, 1:] @ mean
    return error, w, th[n * d:].copy()


# ---- The shader's text ---------------------------------------------------------------------------------------------

HEAD = """\
// Albedos of rough lobes under a uniform sky, of one scattering; fits to integrals. GENERATED by fit_albedos.py, which
// defines the integrals, states the papers, and checks the bounds below. alpha in [1e-3, 1], cos_o = wo.z in (0, 1].
#ifndef BSDF_ALBEDO_GLSL
#define BSDF_ALBEDO_GLSL

#include "base/math.glsl"
#include "bsdf/fresnel.glsl"

// A smooth step from -1 to 1.
vec4 bend(vec4 x) {
    return x / sqrt(vec4(1.0) + x * x);
}

// Smith's masking of a direction with this cosine.
float smith_g1(float alpha, float c) {
    return 2.0 * c / (c + sqrt(c * c + alpha * alpha * max(1.0 - c * c, 0.0)));
}

// Typical cosine of wo to the normals that it sees.
float typical_facet_cosine(float alpha, float cos_o) {
    return sqrt(cos_o * cos_o + square(1.0 - cos_o) * (0.27 * alpha * alpha / (alpha + 0.01)));
}

"""
A_COMMENT = """\
// A, the albedo of facets that reflect all light; between 0.9996 and 1.0045 of it.
// Ref: Turquin 2019, Practical multiple scattering compensation for microfacet models.
"""
# Lines that make the inputs of networks.
OUTSIDE = """\
    float w = cos_o * (1.0 + alpha) / (cos_o + alpha);
    float full = ggx_albedo(alpha, cos_o);
    float u = 1.0 / eta;
    float c = typical_facet_cosine(alpha, cos_o);
    float ct = sqrt(max(1.0 - (1.0 - c * c) * u * u, 1e-12));
    float f = fresnel_dielectric_exact(c, ct, eta);
    float k = sqrt(max(1.0 - u * u, 0.0));
    float g = smith_g1(alpha, cos_o * u + (ct - c * u) / (1.0 + 0.5 * alpha));
"""
# The critical angle is blurred as the facets' normals are.
INSIDE = """\
    float w = cos_o * (1.0 + alpha) / (cos_o + alpha);
    float full = ggx_albedo(alpha, cos_o);
    float u = 1.0 / eta;
    float c = typical_facet_cosine(alpha, cos_o);
    float k = sqrt(max(1.0 - eta * eta, 0.0));
    float d = (c * c - k * k) * u * u;
    float blur = 0.6 * alpha * (sqrt(max(1.0 - cos_o * cos_o, 0.0)) + 0.3 * alpha) * k * u * u + 1e-6;
    float h = sqrt(d * d + blur * blur);
    float q = d / h;
    float ct = sqrt(max(0.5 * (d + h), 1e-12));
    float f = fresnel_dielectric_exact(c, ct, eta);
    float z = cos_o * u + (ct - c * u) / (1.0 + 0.5 * alpha);
    float g = smith_g1(alpha, min(0.5 * (z + sqrt(z * z + 0.04 * alpha * alpha)), 1.0));
    float m = k * k / (k * k + c * c);
    float through = smith_g1(alpha, cos_o);
"""
SHEEN = """\
    float root = sqrt(alpha_g);
    float c = sqrt(cos_o);
    float s = sqrt(c);
    float near = cos_o / (cos_o + root);
    float wide = cos_o / (cos_o + alpha_g);
"""
BOTH = "f * full + (1.0 - f) * g"
CROSS = "through + (full - through) * m"
# name: lines, inputs, factor of the network, neurons (a multiple of four), what is added
NETWORKS = {
    "glass_albedo_outside": (OUTSIDE, "w alpha f g full u", BOTH, 12, ""),
    "glass_albedo_outside_near": (OUTSIDE, "w alpha f g full k ct", BOTH, 16, ""),
    "glass_albedo_inside": (INSIDE, "w alpha f ct q full eta g", "", 20, ""),
    "glass_albedo_inside_near": (INSIDE, "w alpha f ct q full k m through", CROSS, 16, ""),
    "glass_clear_outside": (OUTSIDE, "w alpha g u k ct", "g", 8, ""),
    "glass_clear_inside": (INSIDE, "w alpha f ct q full k m through", CROSS, 16, ""),
    "edge_outside": (OUTSIDE, "cos_o w alpha f full u k", "", 12, "f * full"),
    "edge_inside": (INSIDE, "cos_o w alpha f q full ct k m", "", 12, "f * full"),
    "sheen_network": (SHEEN, "alpha_g root cos_o c s near wide", "", 12, ""),
}
TAIL = """\
// E, the albedo of a clear dielectric that reflects and refracts; eta, the index behind the surface over that before it,
// is clamped to [1/4, 4].
float glass_albedo(float alpha, float cos_o, float eta) {
    float n = clamp(eta, 0.25, 4.0);
    float outside = n < NEAR ? glass_albedo_outside_near(alpha, cos_o, n) : glass_albedo_outside(alpha, cos_o, n);
    float inside = n * NEAR > 1.0 ? glass_albedo_inside_near(alpha, cos_o, n) : glass_albedo_inside(alpha, cos_o, n);
    return n < 1.0 ? min(inside, 1.0) : min(outside, 1.0);
}

// E0, the same where only facets beyond the critical angle reflect.
float glass_albedo_clear(float alpha, float cos_o, float eta) {
    float n = clamp(eta, 0.25, 4.0);
    float e = n < 1.0 ? glass_clear_inside(alpha, cos_o, n) : glass_clear_outside(alpha, cos_o, n);
    return min(e, 1.0);
}

// B, the albedo of facets that reflect t = (F - f0) / (1 - f0), F Fresnel's reflectance and f0 that at normal incidence
// (1 beyond the critical angle): an upper bound.
float ggx_albedo_edge(float alpha, float cos_o, float eta) {
    float n = clamp(eta, 0.25, 4.0);
    float b = n < 1.0 ? edge_inside(alpha, cos_o, n) : edge_outside(alpha, cos_o, n);
    return clamp(b, 0.0, ggx_albedo(alpha, cos_o));
}

// Es, the albedo of the Charlie sheen lobe with alpha_g = roughness^2 in [0.0049, 1]: an upper bound, above 1 at grazing
// angles where alpha_g < 0.07; the lobe must be divided by max(1, Es) there. cos_o >= 1e-4.
// Ref: Conty and Kulla 2017, Production Friendly Microfacet Sheen BRDF.
float sheen_albedo_unbounded(float alpha_g, float cos_o) {
    return max(sheen_network(max(alpha_g, 0.0049), max(cos_o, 1e-4)), 0.0);
}

float sheen_albedo(float alpha_g, float cos_o) {
    return min(sheen_albedo_unbounded(alpha_g, cos_o), 1.0);
}

// The isotropic roughness with (at least) the albedo A of roughness alpha.x along x and alpha.y along y.
float ggx_effective_alpha(vec2 alpha, vec3 wo) {
    float xx = alpha.x * alpha.x;
    float yy = alpha.y * alpha.y;
    float m = 0.5 * (xx + yy);
    float lateral = max(wo.x * wo.x + wo.y * wo.y, 1e-12);
    float p = 0.5 * (xx - yy) * (wo.x * wo.x - wo.y * wo.y) / (lateral * m);
    float k = square(0.5 * (xx - yy) / m);
    float c = wo.z;
    float r = sqrt(m);
ANISOTROPY
    return clamp(r * e, min(alpha.x, alpha.y), max(alpha.x, alpha.y));
}

#endif
"""


def number(x):
    text = "%.7g" % x
    return text if re.search(r"[.e]", text) else text + ".0"


def horner(table, x, y):
    """{(i, j): a} as nested Horner schemes, in x outside."""
    def scheme(coefficients, variable):
        text = ""
        for i in range(max(coefficients), -1, -1):
            term = coefficients.get(i)
            text = (f"{term} + {variable} * ({text})" if term and text else term or f"{variable} * ({text})")
        return text

    rows = {}
    for (i, j), a in table.items():
        rows.setdefault(i, {})[j] = number(a)
    return [(i, scheme(row, y)) for i, row in sorted(rows.items())], scheme


def polynomial_glsl(table):
    rows, scheme = horner(table, "w", "alpha")
    lines = [f"    float p{i} = {text};" for i, text in rows]
    lines.append(f"    return {scheme({i: f'p{i}' for i, _ in rows}, 'w')};")
    return (A_COMMENT + "float ggx_albedo(float alpha, float cos_o) {\n"
            "    float w = cos_o * (1.0 + alpha) / (cos_o + alpha);\n" + "\n".join(lines) + "\n}\n\n")


def head_of(name):
    return f"float {name}(float alpha_g, float cos_o)" if "sheen" in name else \
        f"float {name}(float alpha, float cos_o, float eta)"


def network_glsl(name, weights, v):
    lines, inputs, factor, n, extra = NETWORKS[name]
    text = head_of(name) + " {\n" + lines
    vec = lambda a: "vec4(" + ", ".join(number(x) for x in a) + ")"
    for i in range(0, n, 4):
        text += f"    vec4 n{i} = {vec(weights[i:i + 4, 0])};\n"
        for k, x in enumerate(inputs.split()):
            text += f"    n{i} = n{i} + {vec(weights[i:i + 4, k + 1])} * {x};\n"
    text += f"    float sum = {number(v[0])};\n"
    for i in range(0, n, 4):
        text += f"    sum = sum + dot({vec(v[i + 1:i + 5])}, bend(n{i}));\n"
    return text + f"    return {f'{extra} + ' if extra else ''}{f'({factor}) * ' if factor else ''}sum;\n}}\n\n"

# ---- Putting it together -------------------------------------------------------------------------------------------

FIT_ALPHAS = np.array([1e-3, 3e-3, 0.01, 0.03, 0.06, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1])
FAR = np.array([1.045, 1.06, 1.1, 1.2, 1.33, 1.5, 1.75, 2, 2.25, 2.5, 3, 3.5, 4])
CLOSE = np.array([1, 1.0005, 1.002, 1.005, 1.01, 1.015, 1.02, 1.03, 1.04, 1.052])


def grid(alphas, etas, n_w, n_c):
    """alpha, cos_o and eta, [3, m], dense where the albedos bend."""
    points = []
    for a in alphas:
        w = np.concatenate([[1e-4, 3e-3], (np.arange(n_w) + 0.5) / n_w])
        c = np.concatenate([w * a / (1 + a - w), [0.01], (np.arange(n_c) + 1) / n_c])
        points += itertools.product([a], np.clip(c, 1e-6, 1), etas)
    return np.array(points).T


def random_points(m, seed, near, side):
    """alpha, cos_o, eta of a check; side is 1 outside, -1 inside."""
    rng = np.random.default_rng(seed)
    a = np.where(rng.random(m) < 0.5, 10**rng.uniform(-3, 0, m), rng.uniform(0.05, 1, m))
    w = rng.uniform(0, 1, m)
    c = np.where(rng.random(m) < 0.5, rng.uniform(0, 1, m), w * a / (1 + a - w))
    eta = np.exp(rng.uniform(0, np.log(NEAR), m) if near else rng.uniform(np.log(NEAR), np.log(4), m))
    return np.array([a, np.clip(c, 1e-6, 1), eta**side])


def with_albedos(points):
    return points, albedos(*points, *((16, 16) if points[2][0] >= 1 else (24, 20)))


def table_of(name):
    """Where the network's points come from: (side, whether near 1) of the tables."""
    side = -1 if "inside" in name else 1
    if name.endswith("near"):
        return [(side, True)]
    return [(side, False)] if name.startswith("glass_albedo") else [(side, False), (side, True)]


def goal_of(name, points, values):
    """The goal and the tolerance of a network."""
    a, c, eta = points
    b, e, e0 = values[1:]
    if name.startswith("edge"):
        kink = (np.abs(c * c - (1 - eta * eta)) < 0.15) & (a < 0.12)
        return b + 0.0049, np.where(kink, 0.01, 0.005)
    if name.startswith("glass_clear"):
        return e0 * 1.0098, e0 * np.where(c < 0.0099, 0.03, 0.0102)
    far = np.maximum(eta, 1 / eta)
    low = c < 0.0099
    return (e * np.where(low, 1.0296, 1.00205),
            e * np.where(low, 0.03, 0.0024) * np.where(far > 3.1, 3, np.where(far > 2.6, 1.5, 1)))


def inputs_of(name, prelude, arguments):
    lines, inputs, factor, _, extra = NETWORKS[name]
    head = head_of(name).replace(name, "part")
    parts = [f"{head} {{\n{lines}    return {x};\n}}\n" for x in [*inputs.split(), factor or "1.0", extra or "0.0"]]
    one = 1 + 0 * arguments[0]
    x = [translate(prelude + p)["part"](*arguments) * one for p in parts]
    return np.stack(x[:-2], 1), x[-2], x[-1]


def network(job):
    """Fits one network, moves it to its side of the bound, returns its text."""
    name, prelude, data, check = job
    if name.startswith("sheen"):
        points, values = data
        goal, tolerance = values + 0.0003 + 0.5 * np.minimum(0.009, 0.05 * values), None
        tolerance = 0.0004 + 0.5 * np.minimum(0.009, 0.05 * values)
    else:
        points, values = (np.concatenate([data[t][i] for t in table_of(name)], 1) for i in (0, 1))
        pick = np.random.default_rng(5).permutation(points.shape[1])[:4500]
        points, values = points[:, pick], values[:, pick]
        goal, tolerance = goal_of(name, points, values)
    x, base, offset = inputs_of(name, prelude, points)
    error, w, v = fit_network(x, base, goal - offset, tolerance, NETWORKS[name][3])
    if name.startswith("sheen"):
        points, values = check
    else:
        points, values = (np.concatenate([check[t][i] for t in table_of(name)], 1) for i in (0, 1))
    f = translate(prelude + network_glsl(name, w, v))[name](*points)
    if name.startswith("sheen"):
        v[0] += max(0, (values - 1e-4 - f).max())
    elif name.startswith("edge"):
        v[0] += max(0, (np.maximum(values[1], 0) - 1e-4 - f).max())
    else:
        v *= 0.9998 / (f / values[3 if "clear" in name else 2]).min()
    print(f"{name}: {error:.2f} of its tolerance", flush=True)
    return network_glsl(name, w, v)


def anisotropic_points(m, seed):
    rng = np.random.default_rng(seed)
    a = np.where(rng.random((2, m)) < 0.4, 10**rng.uniform(-3, 0, (2, m)), rng.uniform(0.02, 1, (2, m)))
    phi = rng.uniform(0, np.pi / 2, m)
    phi[::5], phi[1::5] = 0, np.pi / 2
    c = np.where(rng.random(m) < 0.3, 10**rng.uniform(-2, 0, m), rng.uniform(0.01, 1, m))
    return a[0], a[1], phi, c


TERMS = [(g, t) for g in "pk" for t in ("1.0", "c", "r", "p", "k", "c * c", "c * r", "c * p", "r * p", "c * k", "r * k")]


def anisotropy_text(x):
    text = "    float e = 1.0;\n"
    for (group, term), a in zip(TERMS, x):
        text += f"    e = e + {number(a)} * {group}{'' if term == '1.0' else ' * ' + term};\n"
    return TAIL.split("// The isotropic roughness")[1].split("#endif")[0].replace("ANISOTROPY\n", text)


def fit_anisotropy(prelude):
    ax, ay, phi, c = anisotropic_points(3000, 1)
    true = albedos_anisotropic(ax, ay, phi, c, 1.5 + 0 * c, 40)[0]
    logs, ws = np.linspace(np.log(LEAST_ALPHA), 0, 60), np.linspace(0, 1, 60)
    a, w = (v.ravel() for v in np.meshgrid(np.exp(logs), ws, indexing="ij"))
    table = RectBivariateSpline(logs, ws, albedos(a, np.clip(w * a / (1 + a - w), 1e-7, 1), 1 + 0 * a)[0].reshape(60, 60))
    alpha = SimpleNamespace(x=ax, y=ay)
    wo = SimpleNamespace(x=np.sqrt(1 - c * c) * np.cos(phi), y=np.sqrt(1 - c * c) * np.sin(phi), z=c)

    # In the optimiser, the shader's formula with the coefficients as numbers.
    lateral = wo.x**2 + wo.y**2
    m = 0.5 * (ax * ax + ay * ay)
    p, k, r = 0.5 * (ax**2 - ay**2) * (wo.x**2 - wo.y**2) / lateral / m, (0.5 * (ax**2 - ay**2) / m)**2, np.sqrt(m)
    scope = {"p": p, "k": k, "r": r, "c": c}
    columns = np.stack([scope[g] * eval(t, {}, scope) for g, t in TERMS], 1)

    def ratio(x):
        a = np.clip(r * (1 + columns @ x), np.minimum(ax, ay), np.maximum(ax, ay))
        return table.ev(np.log(a), np.clip(c * (1 + a) / (c + a), 0, 1)) / true - 1

    x = np.zeros(len(TERMS))
    for penalty in (3, 30, 300, 3000):
        def residual(x):
            d = ratio(x) - 0.0005
            return np.concatenate([np.where(d < 0, penalty * d, d) / np.sqrt(len(d)), 1e-4 * x])
        x = least_squares(residual, x, max_nfev=60).x
    d = ratio(x)
    print("anisotropy: ratio", np.quantile(d, [0, 0.001, 0.01, 0.1, 0.5, 0.9, 0.99, 1]).round(4))
    return x


def sheen_grid(n_a, n_c, shift):
    a = np.exp(np.linspace(np.log(LEAST_SHEEN), 0, n_a))
    c = np.clip(((np.arange(n_c) + 0.5 + shift) / n_c)**3, 1e-4, 1)
    c = np.append(c, [1e-4, 1])
    a, c = (v.ravel() for v in np.meshgrid(a, c, indexing="ij"))
    return np.array([a, c]), sheen_albedos(a, c)


def fit():
    tables = [(side, near) for side in (1, -1) for near in (False, True)]
    with ProcessPoolExecutor(2) as pool:
        points = [grid(FIT_ALPHAS[1::2] if near else FIT_ALPHAS, (CLOSE if near else FAR)**side, 18, 10 if near else 20)
                  for side, near in tables]
        points += [random_points(3000, 11, near, side) for side, near in tables]
        found = list(pool.map(with_albedos, points))
        data, check = dict(zip(tables, found[:4])), dict(zip(tables, found[4:]))
        a = np.concatenate([10**np.linspace(-3, -1, 14)[:-1], np.linspace(0.1, 1, 20)])
        p = grid(a, [1.0], 40, 25)
        values = albedos(*p)[0]
        table = fit_polynomial(p[1] * (1 + p[0]) / (p[1] + p[0]), p[0], values / (0.5 * (LOW + 1.0045)), (8, 5), 9, 28)
        head = HEAD.replace("#endif\n\n#include", "#endif\n#include") + polynomial_glsl(table)
        prelude = head[head.index("vec4 bend"):]
        anisotropy = pool.submit(fit_anisotropy, prelude)
        jobs = [(n, prelude, *((sheen_grid(30, 40, 0), sheen_grid(53, 67, 0.2)) if n.startswith("sheen") else
                               (data, check))) for n in NETWORKS]
        texts = list(pool.map(network, jobs))
        text = anisotropy_text(anisotropy.result())
    tail = TAIL.split("// The isotropic roughness")[0].replace("NEAR", str(NEAR))
    FILE.write_text(head + "".join(texts) + tail + "// The isotropic roughness" + text + "#endif\n")


def check():
    functions = single(translate(FILE.read_text()))
    f32 = lambda *v: [np.asarray(x, np.float32) for x in v]
    broken = 0

    def say(what, values, low, high):
        nonlocal broken
        bad = not (values.min() >= low and values.max() <= high)
        broken += bad
        print(f"{what:46} {values.min():9.5f} .. {values.max():9.5f}   bounds {low:g} .. {high:g}{'  BROKEN' * bad}")

    with np.errstate(all="ignore"):
        for side, near in itertools.product((1, -1), (False, True)):
            p = random_points(4000, 99, near, side).astype(np.float32).astype(float)
            a, b, e, e0 = with_albedos(p)[1]
            g = {n: functions[n](*f32(*p)).astype(float) for n in ("ggx_albedo_edge", "glass_albedo",
                                                                  "glass_albedo_clear")}
            fit_a = functions["ggx_albedo"](*f32(p[0], p[1])).astype(float)
            place = ("outside" if side > 0 else "inside") + (", near 1" if near else "")
            up, core = p[1] >= 0.01, np.maximum(p[2], 1 / p[2]) <= 2.5
            if side > 0 and not near:
                say("ggx_albedo, cos_o >= 0.01", (fit_a / a)[up], *BOUNDS["A"])
                say("ggx_albedo, below", (fit_a / a)[~up], LOW, 1.02)
            say("ggx_albedo_edge - B, " + place, g["ggx_albedo_edge"] - b, *BOUNDS["B", side, near])
            say("glass_albedo / E, " + place, (g["glass_albedo"] / e)[up & core], *BOUNDS["E", side, near])
            if not near:
                say("glass_albedo / E, beyond 2.5, " + place, (g["glass_albedo"] / e)[up & ~core], LOW, 1.06)
            say("glass_albedo / E, cos_o < 0.01, " + place, (g["glass_albedo"] / e)[~up], LOW, 3)
            say("glass_albedo_clear / E0, " + place, (g["glass_albedo_clear"] / e0)[up], *BOUNDS["E0", side, near])
        p, es = sheen_grid(41, 53, 0.37)
        s = functions["sheen_albedo_unbounded"](*f32(*p)) - es
        say("sheen_albedo - Es", s, -3e-4, 0.02)
        ax, ay, phi, c = anisotropic_points(1500, 5)
        for eta in (1.5, 1 / 1.5):
            true = albedos_anisotropic(ax, ay, phi, c, eta + 0 * c)
            sin = np.sqrt(1 - c * c)
            wo = SimpleNamespace(**dict(zip("xyz", f32(sin * np.cos(phi), sin * np.sin(phi), c))))
            alpha = functions["ggx_effective_alpha"](SimpleNamespace(**dict(zip("xy", f32(ax, ay)))), wo)
            for name, t, arguments in (("ggx_albedo", true[0], ()), ("glass_albedo", true[1], (np.float32(eta),))):
                ratio = functions[name](alpha, np.float32(c), *arguments) / t
                print(f"    {name}, eta {eta:.3g}: quantiles 0, 0.1, 1, 10, 50, 90, 99, 100 %:",
                      np.quantile(ratio, [0, 0.001, 0.01, 0.1, 0.5, 0.9, 0.99, 1]).round(4))
                say(f"{name}, anisotropic, eta {eta:.3g}", ratio, *BOUNDS["anisotropic", name])
    sys.exit(1 if broken else 0)


# What the fits reach: the least and greatest ratio or, for B, difference.
BOUNDS = {"A": (LOW, 1.0045), ("anisotropic", "ggx_albedo"): (0.99, 2), ("anisotropic", "glass_albedo"): (0.97, 2)}
for _side, _near in itertools.product((1, -1), (False, True)):
    BOUNDS["B", _side, _near] = (-2e-4, 0.03)
    BOUNDS["E", _side, _near] = (LOW, 1.0045)
    BOUNDS["E0", _side, _near] = (0.9995, 1.02)

if __name__ == "__main__":
    check() if "--check" in sys.argv else fit()
