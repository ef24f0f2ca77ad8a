"""Metallic-roughness surfaces of luminaire beside those of Mitsuba 3: the scene, the materials in both, and what has to be said between the two.

`compare-mitsuba.py materials` uses it. The scene is made by code: a ball and a tilted slab, flat facets with texture coordinates, over a matt floor, under
a lamp and a sky of one colour. So a material is met at all angles, from outside and, if light enters it, from inside, and by its own reflections.

luminaire gives back what microfacets send to each other, and its masking is correlated by height; Mitsuba does neither. At a roughness of 0.1 both are
below the noise, and the plugins of Mitsuba are taken as they are. For the others `Compensated` is put around the plugin: it multiplies what the plugin says
by the ratio of the two maskings, and adds what is missing. The functions for that are not luminaire's tables: they are integrals made here.

Left out, since they mean something else: of `principled` all that has a body which scatters (its diffuse lobe is Disney's), its coat (GTR1) and its sheen, and
`principledthin`; `roughplastic`, whose body is not that of its own `plastic` (2.2 % darker at a width of 1e-4, 9 % at 0.01 and a cosine of 0.05); sheets of
metallic-roughness words, which reflect at one surface as glTF says (`thindielectric` at two, as luminaire's panes by `transmission` and `eta`).
"""

import math

import drjit as dr
import mitsuba as mi
import numpy as np

# Copper and gold in the bands of linear sRGB (B. Bitterli's Tungsten), as `conductor = "..."` of a scene file has them.
GOLD = ([0.1431189557, 0.3749570432, 1.4424785571], [3.9831604247, 2.3857207478, 1.6032152899])
COPPER = ([0.2004376970, 0.9240334304, 1.1022119527], [3.9129485033, 2.4528477015, 2.1421879552])

# Points a side of the quadrature over microfacets, and of the tables over sqrt(cosine).
NODES = 96
STEPS = 128
# And over the azimuth, where it matters.
TURNS = 24


# The integrals -----------------------------------------------------------------------------------------------------------------


def normals(mu, phi, x, y):
    """Microfacets seen from a direction, each as often as the others: arrays [3, node], and the direction."""
    s = math.sqrt(max(0.0, 1 - mu * mu))
    wo = np.array([s * math.cos(phi), s * math.sin(phi), mu])
    stretched = wo * [x, y, 1]
    stretched /= np.linalg.norm(stretched)
    u, v = (g.ravel() for g in np.meshgrid((np.arange(NODES) + 0.5) / NODES, (np.arange(NODES) + 0.5) / NODES))
    z = 1 - v * (1 + stretched[2])
    r = np.sqrt(np.maximum(1 - z * z, 0))
    h = (np.stack([r * np.cos(2 * np.pi * u), r * np.sin(2 * np.pi * u), z]) + stretched[:, None]) * np.array([[x], [y], [1.0]])
    return h / np.linalg.norm(h, axis=0), wo


def smith(w, x, y):
    return 0.5 * (np.sqrt(1 + ((x * w[0]) ** 2 + (y * w[1]) ** 2) / w[2] ** 2) - 1)


def fresnel_dielectric(cosine, eta):
    sine2 = (1 - cosine**2) / eta**2
    t = np.sqrt(np.maximum(1 - sine2, 0))
    parallel, across = (eta * cosine - t) / (eta * cosine + t), (cosine - eta * t) / (cosine + eta * t)
    return np.where(sine2 >= 1, 1.0, 0.5 * (parallel**2 + across**2))


def fresnel_conductor(cosine, eta, k):
    c2, s2 = cosine**2, 1 - cosine**2
    t0 = eta**2 - k**2 - s2
    a2b2 = np.sqrt(t0**2 + 4 * eta**2 * k**2)
    a = np.sqrt(np.maximum(0.5 * (a2b2 + t0), 0))
    across = (a2b2 + c2 - 2 * a * cosine) / (a2b2 + c2 + 2 * a * cosine)
    t3, t4 = c2 * a2b2 + s2 * s2, 2 * a * cosine * s2
    return 0.5 * across * (1 + (t3 - t4) / (t3 + t4))


def once(mu, alpha, eta):
    """Of a round distribution seen at a cosine: what microfacets that reflect all reflect once; what those of a dielectric of this index do, and let through."""
    h, wo = normals(mu, 0.0, alpha, alpha)
    c = (h * wo[:, None]).sum(0)
    wi = 2 * c * h - wo[:, None]
    up = wi[2] > 1e-9
    wi[2] = np.where(up, wi[2], 1.0)
    lo, li = smith(wo, alpha, alpha), smith(wi, alpha, alpha)
    # Correlated masking over that of `wo`, which the density of visible normals has.
    seen = np.where(up, (1 + lo) / (1 + lo + li), 0.0)
    if eta is None:
        return seen.mean(), 0.0, 0.0
    f = fresnel_dielectric(c, eta)
    sine2 = (1 - c**2) / eta**2
    wt = (c / eta - np.sqrt(np.maximum(1 - sine2, 0))) * h - wo[:, None] / eta
    down = (wt[2] < -1e-9) & (sine2 < 1)
    wt[2] = np.where(down, wt[2], -1.0)
    through = np.where(down, 1 / (1 + smith(wt, alpha, alpha)), 0.0)
    return seen.mean(), (f * seen).mean(), ((1 - f) * through).mean()


def brushed_once(mu, phi, x, y):
    """Of a distribution of two widths seen from a direction: what microfacets that reflect all reflect once."""
    h, wo = normals(mu, phi, x, y)
    wi = 2 * (h * wo[:, None]).sum(0) * h - wo[:, None]
    up = wi[2] > 1e-9
    wi[2] = np.where(up, wi[2], 1.0)
    lo, li = smith(wo, x, y), smith(wi, x, y)
    return np.where(up, (1 + lo) / (1 + lo + li), 0.0).mean()


def even(values):
    """The mean over directions in proportion to their cosine, of values at cosines t^2 for even t in [0, 1]: the integral of 4 t^3 dt."""
    t = np.linspace(0, 1, len(values))
    return np.trapezoid(np.asarray(values).T * 4 * t**3, t).T


def grid():
    return np.maximum(np.linspace(0, 1, STEPS) ** 2, 1e-6)


# The wrapper -------------------------------------------------------------------------------------------------------------------


class Compensated(mi.BSDF):
    """A plugin of microfacets, with masking correlated by height and with what they send to each other (Kulla and Conty, 2017, for widths from 0.25 on;
    Turquin, 2019, up to 0.04; both in between).

    `x`, `y`: the widths. `average_r`, `_g`, `_b`: reflectance, averaged over directions. `ior`: of a dielectric, whose transmission is scaled to all that is
    not reflected; 0 for a metal.
    """

    def __init__(self, props):
        mi.BSDF.__init__(self, props)
        self.nested = next(props[name] for name in props.property_names() if isinstance(props[name], mi.BSDF))
        self.x, self.y, ior = float(props["x"]), float(props["y"]), float(props["ior"])
        self.dielectric = ior > 0
        round_width = math.sqrt(0.5 * (self.x**2 + self.y**2))
        average = np.array([props[f"average_{c}"] for c in "rgb"])
        self.turns = 1 if self.x == self.y else TURNS
        if self.turns == 1:
            table = np.array([once(mu, round_width, ior if self.dielectric else None) for mu in grid()])
            missing = 1 - table[:, 0]
        else:
            turns = np.linspace(0, np.pi / 2, TURNS)
            missing = np.array([[1 - brushed_once(mu, phi, self.x, self.y) for mu in grid()] for phi in turns])
        averages = np.atleast_1d(even(np.atleast_2d(missing).T))
        missing_average = float(averages[0] if self.turns == 1 else (averages[1:] + averages[:-1]).mean() / 2)
        multiple = average**2 * (1 - missing_average) / (1 - average * missing_average)
        wide = min(max((round_width - 0.04) / 0.21, 0), 1)
        self.missing = mi.Float(np.ascontiguousarray(missing.ravel(), dtype=np.float32))
        self.again = mi.Color3f([float(v) for v in (1 - wide) * multiple])
        self.lobe = mi.Color3f([float(v) for v in wide * multiple / (math.pi * missing_average)])
        # The share of paths that look for the lobe of later reflections. Inside, where it is none, no path must: many bounces would multiply what that costs.
        self.share = 0.1 if wide > 0 else 0.0
        if self.dielectric:
            through = (1 - table[:, 1] - missing * multiple[0]) / np.maximum(table[:, 2], 1e-9)
            back = np.array([once(mu, round_width, 1 / ior) for mu in grid()])
            self.through = mi.Float(np.float32(through))
            self.inside = mi.Float(np.float32(1 / (back[:, 1] + back[:, 2])))
        self.distribution = mi.MicrofacetDistribution(mi.MicrofacetType.GGX, self.x, self.y)
        components = [self.nested.flags(i) for i in range(self.nested.component_count())]
        self.m_components = [*components, mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide]
        self.m_flags = self.nested.flags() | self.m_components[-1]

    @staticmethod
    def at(table, mu, first=0):
        place = dr.sqrt(dr.clip(mu, 0, 1)) * (STEPS - 1)
        i = dr.minimum(mi.UInt32(place), STEPS - 2)
        f = place - mi.Float(i)
        low, high = (dr.gather(mi.Float, table, first + i + k) for k in (0, 1))
        return low + f * (high - low)

    def absent(self, w):
        mu = dr.abs(w.z)
        if self.turns == 1:
            return self.at(self.missing, mu)
        place = dr.atan2(dr.abs(w.y), dr.abs(w.x)) * (2 / math.pi * (self.turns - 1))
        i = dr.minimum(mi.UInt32(place), self.turns - 2)
        f = place - mi.Float(i)
        low, high = (self.at(self.missing, mu, (i + k) * STEPS) for k in (0, 1))
        return low + f * (high - low)

    def lam(self, w):
        return 0.5 * (dr.sqrt(1 + ((self.x * w.x) ** 2 + (self.y * w.y) ** 2) / (w.z * w.z)) - 1)

    def both(self, ctx, si, wo, active):
        value, pdf = self.nested.eval_pdf(ctx, si, wo, active)
        wi = si.wi
        front, same = wi.z > 0, wi.z * wo.z > 0
        lo, li = self.lam(wi), self.lam(wo)
        reflected = value * ((1 + lo) * (1 + li) / (1 + lo + li))
        h = dr.normalize(wi + wo)
        h *= dr.select(h.z < 0, -1.0, 1.0)
        all_once = self.distribution.eval(h) / (4 * dr.abs(wi.z) * (1 + lo + li))
        absent = self.absent(wi)
        added = self.again * (absent / (1 - absent) * all_once) + self.lobe * (absent * self.absent(wo) * dr.abs(wo.z))
        if self.dielectric:
            inside = self.at(self.inside, dr.abs(wi.z))
            above = dr.select(front, reflected + added, reflected * inside)
            below = value * dr.select(front, self.at(self.through, dr.abs(wi.z)), inside)
            result = dr.select(same, above, below)
        else:
            result = dr.select(same & front, reflected + added, 0.0)
        cosine = dr.select(same, dr.abs(wo.z) / dr.pi, 0.0)
        ok = active & (wi.z != 0) & (wo.z != 0)
        share = dr.select(front, self.share, 0.0)
        return dr.select(ok, result, 0.0), dr.select(ok, (1 - share) * pdf + share * cosine, 0.0)

    def eval(self, ctx, si, wo, active=True):
        return self.both(ctx, si, wo, active)[0]

    def pdf(self, ctx, si, wo, active=True):
        return self.both(ctx, si, wo, active)[1]

    def eval_pdf(self, ctx, si, wo, active=True):
        return self.both(ctx, si, wo, active)

    def sample(self, ctx, si, sample1, sample2, active=True):
        share = dr.select(si.wi.z > 0, mi.Float(self.share), 0.0)
        even_lobe = sample1 < share
        sample, weight = self.nested.sample(ctx, si, dr.clip((sample1 - share) / (1 - share), 0, 0.99999994), sample2, active & ~even_lobe)
        wo = mi.warp.square_to_cosine_hemisphere(sample2)
        wo.z *= dr.select(si.wi.z < 0, -1.0, 1.0)
        sample.wo = dr.select(even_lobe, wo, sample.wo)
        sample.eta = dr.select(even_lobe, 1.0, sample.eta)
        sample.sampled_type = dr.select(even_lobe, mi.UInt32(+mi.BSDFFlags.GlossyReflection), sample.sampled_type)
        value, pdf = self.both(ctx, si, sample.wo, active)
        sample.pdf = pdf
        # A direction that ends on the wrong side has a weight of zero, while evaluated it would be one of the other kind.
        ok = active & (pdf > 0) & (even_lobe | (dr.max(mi.Color3f(weight)) > 0))
        return sample, dr.select(ok, value / dr.maximum(pdf, 1e-30), 0.0)

    def to_string(self):
        return f"Compensated[{self.nested}]"


# The materials -----------------------------------------------------------------------------------------------------------------


def rgb(values):
    return {"type": "rgb", "value": [float(v) for v in values]}


def compensated(plugin, average, x, y=None, ior=0.0):
    return {"type": "compensated", "nested": plugin, "x": x, "y": y or x, "ior": ior,
            **{f"average_{c}": float(v) for c, v in zip("rgb", np.broadcast_to(average, 3))}}  # fmt: skip


def cases():
    """(name, Mitsuba's plugin and how it was taken, keys of luminaire's material, Mitsuba's description)."""
    as_it_is, with_missing = "as it is", "with masking and compensation"
    averages = {}
    cosines = np.linspace(0, 1, 2049) ** 2
    for name, (eta, k) in (("gold", GOLD), ("copper", COPPER)):
        averages[name] = [float(even(fresnel_conductor(cosines, e, a))) for e, a in zip(eta, k)]
    glass_average = float(even(fresnel_dielectric(cosines, 1.5)))
    found = []

    def metal(name, numbers, x, y):
        return {"type": "roughconductor", "distribution": "ggx", "alpha_u": x, "alpha_v": y, "eta": rgb(numbers[0]), "k": rgb(numbers[1])}

    def glass(alpha):
        return {"type": "roughdielectric", "distribution": "ggx", "alpha": alpha, "int_ior": 1.5, "ext_ior": 1.0}

    for roughness in (0.1, 0.3, 0.6):
        plugin = metal("gold", GOLD, roughness**2, roughness**2)
        keys = f'conductor = "gold"\nroughness = {roughness}'
        if roughness == 0.1:
            found.append((f"gold {roughness}", "roughconductor", as_it_is, keys, plugin))
        found.append((f"gold {roughness}", "roughconductor", with_missing, keys, compensated(plugin, averages["gold"], roughness**2)))
    for roughness, anisotropy in ((0.1, 0.3), (0.3, 0.5)):
        y = roughness**2
        x = y + (1 - y) * anisotropy**2
        keys = f'conductor = "copper"\nroughness = {roughness}\nanisotropy = {anisotropy}'
        found.append((f"copper {roughness} brushed {anisotropy}", "roughconductor", with_missing, keys,
                      compensated(metal("copper", COPPER, x, y), averages["copper"], x, y)))  # fmt: skip
    for roughness in (0.1, 0.3, 0.6):
        keys = f"base_colour = [1, 1, 1]\ntransmission = 1\nior = 1.5\nroughness = {roughness}"
        if roughness == 0.1:
            found.append((f"glass {roughness}", "roughdielectric", as_it_is, keys, glass(roughness**2)))
        found.append((f"glass {roughness}", "roughdielectric", with_missing, keys, compensated(glass(roughness**2), glass_average, roughness**2, ior=1.5)))
    base = [0.9, 0.6, 0.3]
    found.append(("metal of a base colour 0.3", "principled (metallic 1)", with_missing, f"base_colour = {base}\nmetallic = 1\nroughness = 0.3",
                  compensated({"type": "principled", "base_color": rgb(base), "metallic": 1.0, "roughness": 0.3, "specular": 0.5},
                              np.array(base) + (1 - np.array(base)) / 21, 0.09)))  # fmt: skip
    found.append(("glass 0.3", "principled (spec_trans 1)", with_missing, "base_colour = [1, 1, 1]\ntransmission = 1\nior = 1.5\nroughness = 0.3",
                  compensated({"type": "principled", "base_color": rgb([1, 1, 1]), "spec_trans": 1.0, "roughness": 0.3, "eta": 1.5},
                              glass_average, 0.09, ior=1.5)))  # fmt: skip
    colour, distance = [0.8, 0.5, 0.2], 0.7
    found.append(("glass 0 that absorbs", "dielectric and homogeneous", as_it_is,
                  f"base_colour = [1, 1, 1]\ntransmission = 1\nior = 1.5\nroughness = 0\nattenuation_colour = {colour}\nattenuation_distance = {distance}",
                  {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0, "absorption": [-math.log(c) / distance for c in colour]}))  # fmt: skip
    # The plugin divides by what its polynomial says of internal reflection, by which the body is 0.12 % too bright at 1.5; that is taken back.
    paint = [0.7, 0.2, 0.1]
    undone = 1.5**2 * (1 - float(mi.fresnel_diffuse_reflectance(mi.Float(1 / 1.5))[0])) / (1 - glass_average)
    found.append(("plastic 0", "plastic (nonlinear false)", "its polynomial undone", f"base_colour = {paint}\nior = 1.5\nroughness = 0",
                  {"type": "plastic", "int_ior": 1.5, "ext_ior": 1.0, "diffuse_reflectance": rgb(np.array(paint) * undone), "nonlinear": False}))  # fmt: skip
    found.append(("pane of the lecture", "thindielectric", as_it_is, "transmission = [1, 1, 1]\neta = 1.5\nthin = true",
                  {"type": "thindielectric", "int_ior": 1.5, "ext_ior": 1.0}))  # fmt: skip
    return found


# The scene ---------------------------------------------------------------------------------------------------------------------

LAMP, SKY, FLOOR = [5.0, 4.5, 3.5], [0.3, 0.36, 0.48], [0.5, 0.45, 0.4]
EYE, TARGET, FOV = [0.2, 2.2, 6.0], [0.1, 0.85, 0.0], 32.0


def write_obj(path, points, uvs, triangles):
    lines = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in points] + [f"vt {u:.6f} {v:.6f}" for u, v in uvs]
    path.write_text("\n".join(lines + ["f " + " ".join(f"{i + 1}/{i + 1}" for i in face) for face in triangles]) + "\n")


def quads(path, corners):
    """Quadrangles of four corners each, counter-clockwise, u along the first side."""
    points = [p for four in corners for p in four]
    uvs = [(0, 0), (1, 0), (1, 1), (0, 1)] * len(corners)
    write_obj(path, points, uvs, [t for i in range(len(corners)) for t in ((4 * i, 4 * i + 1, 4 * i + 2), (4 * i, 4 * i + 2, 4 * i + 3))])


def meshes(folder):
    """ball.obj, slab.obj, floor.obj and lamp.obj; every corner of a facet is its own."""
    n, m, points, uvs, triangles = 48, 24, [], [], []
    at = lambda i, j: (-1.1 + math.sin(math.pi * j / m) * math.sin(2 * math.pi * i / n), 1.02 + math.cos(math.pi * j / m),
                       math.sin(math.pi * j / m) * math.cos(2 * math.pi * i / n))  # fmt: skip
    for i in range(n):
        for j in range(m):
            first = len(points)
            points += [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]
            uvs += [(i / n, 1 - j / m), (i / n, 1 - (j + 1) / m), ((i + 1) / n, 1 - (j + 1) / m), ((i + 1) / n, 1 - j / m)]
            triangles += ([(first, first + 1, first + 2)] if j + 1 < m else []) + ([(first, first + 2, first + 3)] if j else [])
            if j + 1 == m:
                triangles[-1] = (first, first + 1, first + 3)
    write_obj(folder / "ball.obj", points, uvs, triangles)
    turn, tilt = math.radians(-28), math.radians(-20)

    def place(x, y, z):
        y, z = y * math.cos(tilt) - z * math.sin(tilt), y * math.sin(tilt) + z * math.cos(tilt)
        return (1.25 + x * math.cos(turn) + z * math.sin(turn), 1.0 + y, -x * math.sin(turn) + z * math.cos(turn))

    a, b, c = 0.85, 0.8, 0.1
    sides = [[(-a, -b, c), (a, -b, c), (a, b, c), (-a, b, c)], [(a, -b, -c), (-a, -b, -c), (-a, b, -c), (a, b, -c)],
             [(a, -b, c), (a, -b, -c), (a, b, -c), (a, b, c)], [(-a, -b, -c), (-a, -b, c), (-a, b, c), (-a, b, -c)],
             [(-a, b, c), (a, b, c), (a, b, -c), (-a, b, -c)], [(-a, -b, -c), (a, -b, -c), (a, -b, c), (-a, -b, c)]]  # fmt: skip
    quads(folder / "slab.obj", [[place(*p) for p in side] for side in sides])
    quads(folder / "floor.obj", [[(-5, 0, 5), (5, 0, 5), (5, 0, -5), (-5, 0, -5)]])
    quads(folder / "lamp.obj", [[(-2.4, 4, -1.8), (2.4, 4, -1.8), (2.4, 4, 2.2), (-2.4, 4, 2.2)]])


def write_ours(path, keys, size):
    objects = "".join(f'[[object]]\nmesh = "{name}.obj"\nmaterial = "{material}"\n' for name, material in (("floor", "floor"), ("lamp", "lamp"), ("ball", "it"), ("slab", "it")))
    path.write_text(f"""[film]
width = {size}
height = {size}
[sensor]
position = {EYE}
target = {TARGET}
fov = {FOV}
[environment]
radiance = {SKY}
{objects}[[material]]
name = "floor"
diffuse = {FLOOR}
[[material]]
name = "lamp"
diffuse = [0, 0, 0]
emission = {LAMP}
one_sided = true
[[material]]
name = "it"
{keys}
""")


def theirs(folder, description, size):
    """Mitsuba's scene."""
    description = dict(description)
    absorption = description.pop("absorption", None)
    mesh = lambda name, bsdf, **more: {"type": "obj", "filename": str(folder / f"{name}.obj"), "face_normals": True, "bsdf": bsdf, **more}
    inside = {} if absorption is None else {"interior": {"type": "homogeneous", "albedo": 0.0, "sigma_t": rgb(np.array(absorption) / 100), "scale": 100.0}}
    matt = lambda colour: {"type": "twosided", "b": {"type": "diffuse", "reflectance": rgb(colour)}}
    look = mi.ScalarTransform4f().look_at(origin=EYE, target=TARGET, up=[0, 1, 0])
    film = {"type": "hdrfilm", "width": size, "height": size, "pixel_format": "rgb", "component_format": "float32", "rfilter": {"type": "box"}}
    return mi.load_dict({
        "type": "scene",
        "integrator": {"type": "path" if absorption is None else "volpath", "max_depth": -1, "rr_depth": 5},
        "sensor": {"type": "perspective", "fov": FOV, "near_clip": 0.01, "to_world": look, "film": film, "sampler": {"type": "independent"}},
        "sky": {"type": "constant", "radiance": rgb(SKY)},
        "floor": mesh("floor", matt(FLOOR)),
        "lamp": mesh("lamp", matt([0, 0, 0]), emitter={"type": "area", "radiance": rgb(LAMP)}),
        "ball": mesh("ball", description, **inside),
        "slab": mesh("slab", description, **inside),
    })  # fmt: skip


def register():
    """After a variant is set."""
    mi.register_bsdf("compensated", lambda props: Compensated(props))
