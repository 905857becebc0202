"""The ways in which mutate.py breaks the renderer, in groups: the tests to run, and for each way its name, the file,
what occurs there once, and what it becomes."""

PATH = "shaders/integrator/path.glsl"
PATH_STATE = "shaders/integrator/path_state.glsl"
LIGHT_CHOICE = "shaders/light/choice.glsl"
LIGHT_SAMPLER = "shaders/light/light_sampler.glsl"
AREA = "shaders/light/area.glsl"
SPHERE = "shaders/light/sphere.glsl"
POINT = "shaders/light/point.glsl"
SPOT = "shaders/light/spot.glsl"
BEAM = "shaders/light/beam.glsl"
DIRECTIONAL = "shaders/light/directional.glsl"
SKY = "shaders/light/environment.glsl"
PHONG = "shaders/bsdf/phong.glsl"
MEDIUM = "shaders/medium/medium.glsl"
DISTANCE = "shaders/medium/distance.glsl"
PHASE = "shaders/bsdf/phase.glsl"
WALK = "shaders/integrator/walk.glsl"
RENDER = "shaders/kernels/render.glsl"
CONDUCTOR = "shaders/bsdf/conductor.glsl"
DIELECTRIC = "shaders/bsdf/dielectric.glsl"
PRINCIPLED = "shaders/bsdf/principled.glsl"
PRINCIPLED_FACETS = "shaders/bsdf/principled_facets.glsl"
PRINCIPLED_LOBES = "shaders/bsdf/principled_lobes.glsl"
SHEEN = "shaders/bsdf/sheen.glsl"
FUZZ = "shaders/bsdf/fuzz.glsl"
ROUGH_DIFFUSE = "shaders/bsdf/rough_diffuse.glsl"
FILM = "shaders/bsdf/iridescence.glsl"
LAYERS = "shaders/integrator/layers.glsl"
FRESNEL = "shaders/bsdf/fresnel.glsl"
WARP = "shaders/base/warp.glsl"
SAMPLER = "shaders/base/sampler.glsl"
TRAVERSAL = "shaders/scene/traversal.glsl"
LIST = "shaders/scene/list.glsl"
TRIANGLE = "shaders/scene/triangle.glsl"
PRIMITIVE = "shaders/scene/primitive.glsl"
INTERACTION = "shaders/scene/interaction.glsl"
VERTEX = "shaders/scene/vertex.glsl"
SMOOTH = "shaders/scene/smooth.glsl"
SURFACE = "shaders/integrator/surface.glsl"
INSTANCE = "shaders/scene/instance.glsl"
TEXTURE = "shaders/scene/texture.glsl"
FILTER = "shaders/texture/filter.glsl"
ATTRIBUTES = "shaders/scene/attributes.glsl"
MATERIAL = "shaders/scene/material.glsl"
OPACITY = "shaders/scene/opacity.glsl"
BUMP = "shaders/scene/bump.glsl"
BENT_NORMAL = "shaders/integrator/bent_normal.glsl"
CAMERA = "shaders/scene/camera.glsl"
PIXEL = "shaders/kernels/pixel.glsl"
FIRST_POINTS = "shaders/kernels/first_points.comp.glsl"
FIRST_HITS = "shaders/kernels/first_hits.comp.glsl"
PIXEL_FILTER = "shaders/base/pixel_filter.glsl"
SCENE_BUFFERS = "host/render/scene_buffers.cpp"
POSITIONS = "host/render/positions.cpp"
RENDERER = "host/render/renderer.cpp"
FLATTEN = "host/gpu_scene/flatten.cpp"
LIGHT_TREE = "shaders/light/tree.glsl"
LIGHT_GROUPS = "host/gpu_scene/light_groups.cpp"
PUNCTUAL_LIGHTS = "host/gpu_scene/punctual_lights.cpp"
BEAMS = "host/gpu_scene/beam.cpp"
MATERIAL_ARRAYS = "host/gpu_scene/material_arrays.cpp"
GEOMETRY_ARRAYS = "host/gpu_scene/geometry_arrays.cpp"
INSTANCING = "host/gpu_scene/instancing.cpp"
DENOISE = "shaders/kernels/denoise.comp.glsl"
BLEND = "host/denoise/blend.cpp"
SMOOTH_ALBEDO = "host/denoise/smooth_albedo.cpp"

# What a group runs: filters for the tests of shaders, for those of whole images, which tell much in little time, and
# perhaps for those of the host alone.
INTEGRATOR = ("Interaction*",
              "Furnace*:Roulette*:*RouletteKeeps*:EstimatorTest*Lights:*Dielectric*Within*:*Absorbs:SkyFurnace*:"
              "DirectLight*Under*:DiffuseTransmission*:*Reference*/glass:*Reference*/absorbing_glass")
BSDFS = ("BsdfTest*:Phong*:Dielectric*:Warp*", "Albedo*:SkyFurnace*:*Dielectric*Within*:*Reference*/glass")
LIGHTS = ("*Light*:Environment*:Alias*",
          "DirectLight*:RoundLight*Above*:EnvironmentLight*Texel*:*Reference*/small_sphere_light")
TREES = ("LightTree*:LightChoice*", "EstimatorTest*HoweverLights*:ManyLight*", "LightTree*:TextureMean*")
PUNCTUAL = ("PunctualLight*:LightRobust*", "PunctualLight*:Sun*:Orthographic*:ScaleTest*Mean*")
BEAMED = ("RecordsTest*", "BeamTest*:FormFactorTest*", "Flatten.ABeam*")
TERMINATOR = ("Interaction*", "Terminator*")
CAMERAS = ("WarpTest*", "PanoramaTest*:PixelFilterTest*:ClampTest*")
SAMPLES = ("Sampler*:Math*", "AdaptiveTest*:Furnace*:*Lens*:*Blur*:Aov*:*Reference*/depth_of_field")
SCATTERING = ("MediumTest*:BsdfTest*", "ScatteringTest*:DeepMediumTest.ReflectsWhatChandrasekharSays")
SCATTERED_PATHS = ("MediumTest.TheMeanCosine*", SCATTERING[1], "SealedMedia*")
CATCHERS = ("*Traversal*", "CatcherTest*")
GEOMETRY = ("*Traversal*:*BruteForce*:*Escape*:Spawn*", "DirectLight*Under*:SkyFurnace*:AovTest*:ListTest*")
INSTANCES = ("InstanceTest*", "InstancedNormals*:*InstanceTest*", "Instancing*:MediaAt*")
LAMPS = ("LampTest*", "LampTest*", "Instancing*")
FRAMES = ("Spawn*", "ScaleTest*:FloorTest*")
TEXTURES = ("TextureTest*", "TexturedTest*:NormalMap*:Bump*:Opacity*:*Reference*/textured*:*Reference*/mask")
MEDIA = ("Records*", "NestedMedia*:*Reference*/nested_glass")
LAYERED = ("PrincipledTest*:Records*", "PrincipledPicture*")
CHANGES = ("Records*", "SessionTest*:UpdateTest*", "LiveScene*:SceneStages*")
MOTION = ("InstanceTest*", "MotionTest*", "Projection*:AnimatedScene*")
COVERAGE = ("InstanceTest*", "CoverageTest*:AovTest*", "IdLayers*")
DENOISING = ("DenoiseTest*", "GuidesTest*", "Blend*:SmoothAlbedo*:DenoiseImage*:Oidn*:TileSpans*:Merge*")
DEVICES = ("Exponential*:Records*", "*IdentityTest*Suit*:*IdentityTest*Tuned*:FiniteTest*")

GROUPS = [
    (COVERAGE, [
        ("first hits outside of a fisheye", FIRST_HITS, "view.sees && is_hit(hit)", "is_hit(hit)"),
        ("first hits of another crop", FIRST_HITS, "parameters.crop + uvec2", "uvec2"),
        ("first hits by any sampler", "host/render/first_hits.cpp", "constants[CONSTANT_SAMPLER] = SAMPLER_SOBOL;", ""),
        ("first hits of the shape before", FIRST_HITS, "hit_id(hit) + 1u", "max(hit_id(hit), 1u)"),
        ("distances along the axis", POSITIONS, "parallel ? double(at[3])", "true ? double(at[3])"),
        ("the least covering first", "host/film/id_layers.cpp", "a.hits > b.hits", "a.hits < b.hits"),
    ]),
    (MOTION, [
        ("motion of another crop", FIRST_POINTS, "parameters.crop + tile.origin + at", "tile.origin + at"),
        ("motion back to the frame before", "host/render/motion.cpp", "now.way(*from, to.value_or(film))",
         "now.way(to.value_or(film), *from)"),
        ("motion of a deformed mesh as it is", "host/render/motion.cpp", "transformed(motion.before, at(motion.positions_before))",
         "transformed(motion.before, at(motion.positions_now))"),
        ("motion the long way around", "host/scene/projection.cpp", "way.x = std::remainder(way.x, size_.x)", "way.x += 0.0"),
        ("positions before without added vertices", "host/load/gltf/poser.cpp", "positions.push_back(positions[vertex])",
         "positions.push_back(dvec3(0.0))"),
    ]),
    (INTEGRATOR, [
        ("cosine dropped from direct light", PATH, "value.f * cosine * light.Li", "value.f * light.Li"),
        ("emission counted in full beside light samples", PATH, "return power_heuristic(pdf_bsdf, pdf_light);",
         "return 1.0;"),
        ("MIS weight of emission with twice the light's density", PATH, "power_heuristic(pdf_bsdf, pdf_light)",
         "power_heuristic(pdf_bsdf, 2.0 * pdf_light)"),
        ("ideal scattering taken for a density", PATH, "path.delta = scattered.delta", "path.delta = false"),
        ("roulette without reweighting", PATH, "path.beta /= survival;", ""),
        ("roulette blind to refraction", PATH, "max_component(path.beta) * path.eta_scale",
         "max_component(path.beta) / path.eta_scale"),
        ("roulette after ideal scattering as after any", PATH, "if (!path.delta) survival", "survival"),
        ("roulette with the number that chose the lobe", PATH,
         "unit_float(sampler_pair(random, pair + PAIR_SURVIVAL).x)", "unit_float(u.z)"),
        ("the same dimensions at every bounce", PATH, "path.depth * PAIRS_PER_BOUNCE", "0u"),
        ("one bounce too many", PATH, "path.depth == parameters.max_depth", "path.depth > parameters.max_depth"),
        ("absorption also outside of the solid", MEDIUM, "uvec2(front ? behind : MEDIUM_NONE, 0u)", "uvec2(behind, 0u)"),
        ("a thin sheet bounds the medium around it", MEDIUM, "if (behind == MEDIUM_SAME) return here;",
         "if (behind == MEDIUM_SAME) return MEDIA_NONE;"),
        ("light through a sheet absorbed by the medium before it", PATH,
         "if (!viewers_side) media = media_beyond(path.media, x.material.medium, x.s.front);", ""),
        ("light through a sheet looked for from the viewer's side", PATH,
         "ray.o = vertex_spawn_origin(interaction_vertex(x.s), viewers_side);",
         "ray.o = vertex_spawn_origin(interaction_vertex(x.s), true);"),
    ]),
    (BSDFS, [
        ("a sheet's sides chosen otherwise than the density says", "shaders/bsdf/diffuse_transmission.glsl",
         "bool reflected = uc < pmf.x;", "bool reflected = uc < 0.5;"),
        ("1/pi missing from Lambert's reflector", "shaders/bsdf/diffuse.glsl", "reflectance * INV_PI", "reflectance"),
        ("Phong normalised for its sampling, not its albedo", PHONG, "0.5 * (n + 2.0)", "0.5 * (n + 1.0)"),
        ("Phong's lobes chosen otherwise than the density says", PHONG, "if (uc < phong_lobe_pmf(kd, ks))",
         "if (uc < 0.5)"),
        ("GGX sampled as if seen from above", WARP, "0.5 * (1.0 + v.z)", "1.0"),
        ("GGX shadowing without correlation in the weight only", CONDUCTOR,
         "wi.z * (wo.z + reach_o) / (wi.z * reach_o + wo.z * ggx_reach(alpha, wi))",
         "2.0 * wi.z / (wi.z + ggx_reach(alpha, wi))"),
        ("eta swapped in Snell's law", DIELECTRIC, "-wo.xy / eta", "-wo.xy * eta"),
        ("eta^2 missing from refracted radiance", DIELECTRIC, "vec3(1.0 / square(eta))", "vec3(1.0)"),
        ("Schlick's angle on the wrong side of the glass", FRESNEL, "eta >= 1.0 ? cos_o : cos_t", "cos_o"),
    ]),
    (LIGHTS, [
        ("lights off by one", LIGHT_CHOICE, "groups.placed + groups.suns : i;",
         "groups.placed + groups.suns : (i + 1u) % max(groups.placed, 1u);"),
        ("what the choice of sky or suns leaves not stretched", LIGHT_CHOICE, "bits = light_stretch(rest,",
         "light_stretch(rest,"),
        ("the sky chosen twice as often as its probability says", LIGHT_CHOICE, "bits >> 1u < sky;", "bits >> 2u < sky;"),
        ("probabilities without the share of suns and sky", LIGHT_GROUPS, "(double(group_fraction) / WHOLE)",
         "(double(group_fraction) / group_fraction)"),
        ("surfaces taken for the first of the lights", PATH, "light_at(s.light)", "light_at(0u)"),
        ("lights chosen with a wrong probability", WARP, "column.y < entry.threshold",
         "column.y < entry.threshold / 2u"),
        ("one word chooses the light and the point on it", LIGHT_SAMPLER, "uvec2(u.z, more)", "uvec2(u.x, more)"),
        ("cosine missing from an area light's density", AREA, "distance_squared / abs(cos_light)", "distance_squared"),
        ("emission from the back", AREA, "front || l.two_sided != 0u", "true"),
        ("shadow rays end on the light", AREA,
         "to_light + light_end_error(l.error, distance_squared * inv_distance) * n", "to_light"),
        ("a sphere light's density 2 % low", SPHERE, "front ? warp_cone_pdf(", "front ? 0.98 * warp_cone_pdf("),
        ("a light's density without the probability of its choice", LIGHT_SAMPLER,
         "return light_pmf(i, lamp, lit) * pdf;", "return pdf;"),
        ("solid angle missing from the choice of texels", "host/gpu_scene/environment_map.cpp",
         "0.0) * solid_angle", "0.0) * (solid_angle > 0.0 ? 1.0 : 0.0)"),
        ("light samples of all of the sky", "host/gpu_scene/environment_map.cpp", "bright - mean", "bright"),
        ("columns of the row above", SKY, "environment_choose(row.i * size.x, size.x, u.x)",
         "environment_choose(max(row.i, 1u) * size.x - size.x, size.x, u.x)"),
        ("texels next to those that the tables chose", SKY, "return EnvironmentChoice(lo, min(",
         "return EnvironmentChoice(min(lo + 1u, n - 1u), min("),
        ("sky turned the wrong way", SKY, "turn.x * w.x - turn.y * w.z", "turn.x * w.x + turn.y * w.z"),
    ]),
    (TERMINATOR, [
        ("light begins at flat triangles", SMOOTH, "return 0.5 * MARGIN * sum;", "return 0.0;"),
        ("light begins above the side that is hollow", SMOOTH, "max(side * dot(e1,", "max(-side * dot(e1,"),
        ("light samples begin at the triangle, BSDF samples above it", PATH,
         "vec3 p = LIT_FROM_BEHIND ? v.p + v.lift : vertex_spawn_origin(v, true);", "vec3 p = v.p + v.error * v.n;"),
        ("the horizon is that of the triangle", SURFACE, "x.horizon = x.unbent;", ""),
        ("the back of a shading normal is black", SURFACE, "x.unbent = facing_normal(x.s.wo, x.s.n, x.unbent);", ""),
    ]),
    (CATCHERS, [
        ("a catcher's shadow is also there without what casts it", TRAVERSAL,
         "if (HAS_CATCHERS && t.alone && !stays_alone(scene_surface(position))) continue;", ""),
        ("lamps are no bodies beside catchers", TRAVERSAL, "return surface.light != NO_LIGHT || scene_material",
         "return scene_material"),
        ("what a catcher reflects is part of its shadow", PATH_STATE, "    estimate.strayed = true;\n", ""),
    ]),
    (SAMPLES, [
        ("aperture not uniform", CAMERA, "? warp_disk(u)", "? u.x * cos_sin_turn(u.y)"),
        ("lens and pixel share their random numbers", CAMERA, "PAIR_LENS", "PAIR_PIXEL"),
        ("half a pixel off", PIXEL_FILTER, "return vec2(pixel) + u;", "return vec2(pixel) + 0.5 + u;"),
        ("a fold of the Sobol matrix missing", SAMPLER, "i ^= (i >> 4u) & 0x0F0F0F0Fu;", ""),
        ("adaptive samples steered by those of the same half", "host/session/adaptive.cpp",
         "plan_extra_samples(states[2 * (1 - h)]", "plan_extra_samples(states[2 * h]"),
        ("sums without compensation", "shaders/base/math.glsl", "(t - sum) - y", "0.0 * ((t - sum) - y)"),
    ]),
    (GEOMETRY, [
        ("rays leave on the wrong side", VERTEX, "viewers_side ? v.error : -v.error",
         "viewers_side ? -v.error : v.error"),
        ("child boxes rounded inwards", "host/bvh/quantise.cpp",
         "std::ceil(steps(x)));\n        while (decode(q) < x)", "steps(x));\n        while (decode(q + 1) < x)"),
        ("a single child left to visit is forgotten", TRAVERSAL, "down && siblings",
         "down && bitCount(t.pending >> PENDING_SHIFT) > 1"),
        ("the stack a word too short", "shaders/scene/stack.glsl", "BVH_DEPTH > 1u ? int(BVH_DEPTH) - 1",
         "BVH_DEPTH > 2u ? int(BVH_DEPTH) - 2"),
        ("the leaves of a node but one forgotten", TRAVERSAL, "t.leaves &= t.leaves - 1u;", "t.leaves = 0u;"),
        ("the last of a list of primitives forgotten", LIST, "if (found.t > 0.0 &&",
         "if (i < int(LIST) - 1 && found.t > 0.0 &&"),
        ("a shared vertex of a list taken for its neighbour", LIST, "v[corner] = v[first];", "v[corner] = v[first ^ 1];"),
        ("boxes without a margin, a little small", "shaders/scene/node.glsl", "vec3 far = start + margin",
         "vec3 far = start - margin"),
        ("edges belong to no triangle", TRIANGLE, "any_negative(e) && any_positive(e)",
         "!(e.x * e.y > 0.0 && e.y * e.z > 0.0)"),
        ("of equal hits the last one found wins", PRIMITIVE, "place < hit.place", "true"),
        ("the distance of a sliver not kept within its box", TRIANGLE, "t0 = lesser(greater(t0, begin), end);", ""),
        ("of two triangles always the first", TRIANGLE, "bool second = meets1 && !(meets0 && t0 <= t1);",
         "bool second = !meets0;"),
        ("the first triangle's normals on the second", SMOOTH, "normals.yz = normals.zw;",
         "normals.yz = normals.yz;"),
    ]),
    (LAMPS, [
        ("a lamp's density as if it were as large as its mesh", LIGHT_SAMPLER,
         "if (is_lamp(lamp)) l.pdf_area /= scene_lamp(lamp).area;", ""),
        ("a lamp's light chosen for the point in the frame of the scene", LIGHT_CHOICE,
         "light_tree_choose(way, lit_in_lamp(lit, lamp), random,", "light_tree_choose(way, lit, random,"),
        ("probability of another way to a lamp's light", LIGHT_CHOICE, "scene_light_trail(i)",
         "scene_light_trail(i ^ 1u)"),
        ("mirrored lamps inside out", "host/gpu_scene/lamps.cpp", "placed.record.mirrored = determinant < 0.0;",
         "placed.record.mirrored = 0;"),
        ("the image on a mirrored lamp not mirrored", LIGHT_SAMPLER, "mirrored != 0u) b = b.yx;",
         "mirrored != 0u) b = b;"),
    ]),
    (FRAMES, [
        ("the frame's origin not subtracted from quads", FLATTEN, "c[i] = frame_.point(quad.corners[i])",
         "c[i] = frame_.vector(quad.corners[i])"),
        ("the frame's origin not subtracted from spheres", FLATTEN, "frame_.point(sphere.center)",
         "frame_.vector(sphere.center)"),
        ("the frame's unit forgotten for radii", FLATTEN, "frame_.length(sphere.radius)", "float(sphere.radius)"),
        ("the frame's unit forgotten for media", MATERIAL_ARRAYS,
         "vec3(frame.unit * dvec3(m.medium.absorption))", "vec3(0.0 * frame.unit + dvec3(m.medium.absorption))"),
        ("the camera rounded before it is in the frame", RENDERER, ".position = frame.point(camera.position)",
         ".position = frame.point(dvec3(vec3(camera.position)))"),
        ("depths left in the frame", POSITIONS, "values[i + 3] *= float(frame_.unit);", ""),
        ("the bound on a triangle's points halved", "host/gpu_scene/ray_error.cpp", "3.0 * max(abs(lo)",
         "1.5 * max(abs(lo)"),
        ("rays begin on their surfaces", VERTEX, "(viewers_side ? v.error : -v.error) * v.n", "0.0 * v.n"),
        ("rays begin beside their points, along another axis", VERTEX,
         "(viewers_side ? v.error : -v.error) * v.n", "(viewers_side ? v.error : -v.error) * v.n.yzx"),
    ]),
    (TEXTURES, [
        ("columns of a tile of texels for its rows", TEXTURE, "t.first + 4u * tile + within.y), within.x",
         "t.first + 4u * tile + within.x), within.y"),
        ("sRGB codes taken for light", TEXTURE, "code.rgb = srgb_decode(code.rgb);", ""),
        ("textures upside down", "host/gpu_scene/texture_table.cpp", "vec3(-row_v.x, -row_v.y, 1.0f - row_v.z)", "row_v"),
        ("no texel across the seam", FILTER, "repeats ? 0 : last", "last"),
        ("mirrored textures repeated", FILTER, "at = turned ? 2.0 - at : at;", "at = turned ? at - 1.0 : at;"),
        ("weights of the two axes swapped", TEXTURE, "vec4 texels[4];", """vec4 texels[4];
    float weight = at.u.weight;
    at.u.weight = at.v.weight;
    at.v.weight = weight;"""),
        ("a colour always the first of the four texels", TEXTURE, "random.x < at.u.weight ? at.u.second : at.u.first",
         "at.u.first"),
        ("green for blue where a number is asked for", TEXTURE, "texel.x >> 8u * channel & 255u",
         "texel.x >> 8u * min(channel, 1u) & 255u"),
        ("the second triangle's coordinates for the first", ATTRIBUTES, "uintBitsToFloat(second ? cd.xy : ab.zw)",
         "uintBitsToFloat(cd.xy)"),
        ("lights sampled without their textures", LIGHT_SAMPLER, "s.Li *= light_texture(s.light, at);", ""),
        ("lights hit without their textures", PATH, "light_texture(s.light, s.attributes)", "vec3(1.0)"),
        ("a lamp sampled where it is transparent", LIGHT_SAMPLER,
         "s.Li *= material_opacity(scene_light_textures(s.light).material, at)", "s.Li *= 1.0"),
        ("both triangles of a lamp for the first", LIGHT_SAMPLER, "place.second = b.y > b.x;", "place.second = false;"),
        ("what is hidden from the camera is there for no ray", OPACITY, "HAS_HIDDEN && of_camera && ", "HAS_HIDDEN && "),
        ("the same rays pass all surfaces", OPACITY, "floatBitsToUint(ray.d), id)", "floatBitsToUint(ray.d), 0u)"),
        ("a shadow ray dimmed by the last surface alone", OPACITY, "depth += optical_depth(opacity);",
         "depth = optical_depth(opacity);"),
        ("the other triangle of a pair not tested", OPACITY, "bool goes_on = candidate.first && is_nearer(second, hit);",
         "bool goes_on = false;"),
        ("nothing behind a hole casts a shadow", TRAVERSAL,
         "decide(t.ray, t.shear, t.any_hit, t.of_camera, t.hit, t.candidate, t.depth);\n    if (t.any_hit && is_hit(t.hit)) bvh_end(t);",
         "decide(t.ray, t.shear, t.any_hit, t.of_camera, t.hit, t.candidate, t.depth);\n    if (t.any_hit) bvh_end(t);"),
        ("opaque below the cutoff", MATERIAL, "opacity >= textures.cutoff ? 1.0 : 0.0",
         "opacity >= textures.cutoff ? 0.0 : 1.0"),
        ("light below the surface of a bent normal lost", BENT_NORMAL,
         "scattered.wi = mirrored(scattered.wi, n);", "scattered.pdf = 0.0;"),
        ("the first triangle's heights on the second", BUMP,
         "if (hit_second(hit)) edges = UvEdges(p.c - p.a, p.d - p.a, c - a, uintBitsToFloat(cd.zw) - a);", ""),
        ("heights that a mirrored image turns not turned", FILTER, "turned ? -float(n) : float(n)", "float(n)"),
        ("the frame's unit forgotten for heights", MATERIAL_ARRAYS, "frame.length(double(bump->scale))",
         "frame.length(frame.unit * double(bump->scale))"),
        ("a facet seen from behind", BENT_NORMAL, "if (up >= MIN_SINE) return dot(wo, ns) < 0.0 ? -ns : ns;", "return ns;"),
    ]),
    (MEDIA, [
        ("a medium of a higher priority hidden by a lower one", MEDIUM, "lessThanEqual(m >> MEDIUM_INDEX_BITS",
         "greaterThan(m >> MEDIUM_INDEX_BITS"),
        ("all media left with one", MEDIUM, "return front ? media_entered(here, behind) : media_left(here, behind);",
         "return front ? media_entered(here, behind) : MEDIA_NONE;"),
        ("the second of the media lost when the first is left", MEDIUM, "uvec4(here.x ? m.y : m.x", "uvec4(here.x ? m.z : m.x"),
        ("nothing around the camera", PATH_STATE, "NESTED_MEDIA ? media : MEDIA_NONE", "MEDIA_NONE"),
        ("indices of refraction against the air", SURFACE, "if (!NESTED_MEDIA || !bsdf_refracts(x.material)) return;",
         "return;"),
        ("a stated exterior index ignored", MEDIUM, "return own_eta ? eta :", "return"),
        ("the exterior nearest to the camera's medium first", "host/render/media_at.cpp",
         "p.second.nearest_exit);", "-p.second.nearest_exit);"),
    ]),
    (LAYERED, [
        ("a coat that takes nothing from what lies below", PRINCIPLED_LOBES, "return max(1.0 - p.coat * reflected, 0.0);",
         "return 1.0;"),
        ("sheen that takes nothing from what lies below", PRINCIPLED_LOBES,
         "return above * (1.0 - max_component(s.record.sheen_color) * albedo);", "return above;"),
        ("light that metal facets throw at each other lost", PRINCIPLED_LOBES, "p.multiscatter += metal * mean.lost *",
         "p.multiscatter += 0.0 * metal * mean.lost *"),
        ("light that glass facets throw at each other on both sides in full", PRINCIPLED_LOBES,
         "p.through += (1.0 - back) * lost", "p.through += lost"),
        ("the same facets measured at every vertex", PRINCIPLED_FACETS, "/ float(FACETS) + shift)", "/ float(FACETS))"),
        ("light that facets send below the surface not lost", PRINCIPLED_FACETS, "if (wi.z <= 0.0) return 1.0;",
         "if (wi.z <= 0.0) return 0.0;"),
        ("radiance of diffuse transmission not divided by eta squared", PRINCIPLED,
         "p.through * INV_PI / (p.refracts ? p.eta * p.eta : vec3(1.0))", "p.through * INV_PI"),
        ("radiance of ideal refraction not divided by eta squared", PRINCIPLED,
         "if (p.ideal) transmitted /= square(eta);", ""),
        ("the density of refraction without eta squared", PRINCIPLED, "jacobian * square(eta) / (wo.z + reach_o)",
         "jacobian / (wo.z + reach_o)"),
        ("the density of reflection as if nothing were transmitted", PRINCIPLED, "(through ? fraction : 1.0 - fraction)",
         "(through ? fraction : 1.0)"),
        ("anisotropy not squared", PRINCIPLED_LOBES, "mix(alpha, 1.0, square(r.anisotropy))", "mix(alpha, 1.0, r.anisotropy)"),
        ("roughness taken for alpha", PRINCIPLED_LOBES, "float alpha = square(r.roughness);", "float alpha = r.roughness;"),
        ("metal as bright at grazing angles as elsewhere", PRINCIPLED_FACETS,
         "reflected += p.r_schlick * schlick_weight(cos_o);", "reflected += 0.0;"),
        ("the weight of the dielectric's reflection ignored", PRINCIPLED_LOBES, "d_0 = r.specular * min(", "d_0 = min("),
        ("total reflection not total where the reflection has a weight", PRINCIPLED_FACETS,
         "reflected += p.r_total * vec3(total);", "reflected += 0.0;"),
        ("the film seen under the outer angle", FILM, "thickness * cos_film", "thickness * cos_o"),
        ("the film's phase turned at the wrong base", FILM, "mix(vec3(PI), vec3(2.0 * PI)", "mix(vec3(2.0 * PI), vec3(PI)"),
        ("rough diffuse light lost on one side only", ROUGH_DIFFUSE, "lost_o * lost_i / (1.0 - mean)", "lost_o"),
        ("sheen shadowed at steep angles as at flat ones", SHEEN,
         "x < 0.5 ? sheen_log_lambda(x, alpha)", "true ? sheen_log_lambda(x, alpha)"),
        ("fuzz that takes nothing from what lies below", PRINCIPLED_LOBES, "return 1.0 - reflected;", "return 1.0;"),
        ("a coat as bright under fuzz as without", PRINCIPLED_LOBES, "p.coat *= below_fuzz;", ""),
        ("fuzz that sends light on instead of back", FUZZ, "shape.x * wi.xy + shape.y", "shape.x * wi.xy - shape.y"),
        ("fuzz sampled by Lambert's law", PRINCIPLED, "fuzz_direction(p.fuzz_shape, wo, u)",
         "warp_cosine_hemisphere(u)"),
        ("red bent more than blue", PRINCIPLED_FACETS, "ior - h, min(ior, 1.0 + MIN_FACET_ALPHA)), ior, ior + h)",
         "ior + h, 1.0), ior, ior - h)"),
        ("all colours go where one is bent", PRINCIPLED, "transmitted *= along;", ""),
        ("the coat's darkening forgotten for the diffuse base", PRINCIPLED_LOBES, "p.diffuse *= factor;", ""),
        ("lights sampled above their coat", PATH, "light.Li *= emitted_fraction(light, lit);", "light.Li *= 1.0;"),
        ("lights hit above their coat", PATH, "emission_weight(path, path.pdf_bsdf, pdf_light) * fraction *",
         "emission_weight(path, path.pdf_bsdf, pdf_light) *"),
        ("the front culled", OPACITY, "return dot(n, ray.d) > 0.0;", "return dot(n, ray.d) < 0.0;"),
        ("every number from an image's red", MATERIAL, "channel == 0u ? texel.r : texel.g", "texel.r"),
        ("the tangent turned the wrong way", LAYERS, "p.rotation.x * t + p.rotation.y * b", "p.rotation.x * t - p.rotation.y * b"),
    ]),
    (TREES, [
        ("cones of normals dropped", LIGHT_TREE, "float cosine = cosine_of_rest(rest, b) + LIGHT_TREE_SLACK;",
         "float cosine = 1.0;"),
        ("importance outside a spot's cone", LIGHT_TREE,
         "return cosine > unpack_half_sine(c.cone >> LIGHT_TREE_EMISSION_SHIFT).x", "return cosine > -2.0"),
        ("receiver's cosine inverted", LIGHT_TREE, "clamp(-dot(w, lit.n), -1.0, 1.0)", "clamp(dot(w, lit.n), -1.0, 1.0)"),
        ("a choice leaves its own randomness to the next", "shaders/base/random_range.glsl", "r.u -= begin;", ""),
        ("probability of another light's way", LIGHT_CHOICE, "scene_light_trail(is_lamp(lamp) ? lamp : i)",
         "scene_light_trail((is_lamp(lamp) ? lamp : i) ^ 1u)"),
        ("the sky weighted as if chosen more often", LIGHT_CHOICE, "NO_LIGHT, range_part(groups, 3u));",
         "NO_LIGHT, 1.2 * range_part(groups, 3u));"),
        ("a sphere seen from inside taken for one afar", LIGHT_TREE, "if (d2 > r2) {", "if (d2 > 0.0) {"),
        ("no way by strength alone", LIGHT_CHOICE, "uvec4(ends.x / LIGHT_TREE_WAYS, ends, RANGE_PARTS)",
         "uvec4(0u, ends, RANGE_PARTS)"),
        ("cones without those of the lights", "host/gpu_scene/light_tree.cpp", "max_angle(cosine) + double(light.normals)",
         "max_angle(cosine)"),
        ("mean of the triangle beside an emitter's", "host/gpu_scene/area_lights.cpp", "return {{0, 0}, {1, 0}, {0, 1}};",
         "return {{1, 1}, {1, 0}, {0, 1}};"),
    ]),
    (PUNCTUAL, [
        ("a point's light falls off with its distance, not with the square", POINT,
         "l.radiance * inv_distance * inv_distance", "l.radiance * inv_distance"),
        ("a surface on which a point lies hides it", POINT, "s.t_max = LIGHT_T_MAX;", "s.t_max = FLOAT_MAX;"),
        ("points weighted as if rays could hit them", POINT, "s.delta = true;", "s.delta = false;"),
        ("a spot's edge falls off linearly", BEAM, "return t * t * ", "return t * "),
        ("every spot falls off as smoothstep", BEAM, "cone.z * (2.0", "(2.0"),
        ("a spot shines everywhere", SPOT, "s.Li *= cone_falloff(l.e1, l.e2, -s.wi);", ""),
        ("a spot shines backwards", SPOT, "l.e2, -s.wi)", "l.e2, s.wi)"),
        ("a cone's angles swapped in its choice", BEAMS, "inner + (outer - inner) * between",
         "outer - (outer - inner) * between"),
        ("directional light from where it goes", DIRECTIONAL, "s.wi = l.e1;", "s.wi = -l.e1;"),
        ("nothing far away hides directional light", DIRECTIONAL,
         "s.delta = true;\n    s.shadow = s.wi;\n    s.t_max = FLOAT_MAX;",
         "s.delta = true;\n    s.shadow = s.wi;\n    s.t_max = LIGHT_T_MAX;"),
        ("a sun wider for rays than for samples", DIRECTIONAL, "dot(chord, chord) <= l.e2.x",
         "dot(chord, chord) <= 1.1 * l.e2.x"),
        ("a sun's density without the probability of its choice", LIGHT_SAMPLER,
         "sun_pmf(i, lit) * warp_cone_pdf(l.e2.x)", "warp_cone_pdf(l.e2.x)"),
        ("suns seen by the camera", PATH, "if (path.depth == 0u) return;\n    LightGroups", "LightGroups"),
        ("directional light weighted as if rays could hit it", DIRECTIONAL, "s.delta = true;", "s.delta = false;"),
        ("directional light chosen as in a scene of unit size", PUNCTUAL_LIGHTS, "append(record, radius_ * radius_);",
         "append(record, 1.0);"),
        ("the frame's unit forgotten for intensities", PUNCTUAL_LIGHTS,
         "dvec3(intensity) / (frame_.unit * frame_.unit)", "dvec3(intensity)"),
        ("parallel rays from one point", CAMERA, "Ray(camera.position + s.x * camera.right - s.y * camera.up, camera.forward)",
         "Ray(camera.position, camera.forward)"),
    ]),
    (BEAMED, [
        ("a beam chosen as if it shone everywhere", BEAMS, "return fraction;", "return 1.0;"),
        ("a spread linear in the sine", BEAM, "/ max(abs(cosine), GRAZING)", ""),
        ("a cone's axis mirrored", BEAM, "vec3(l.e1.yz, l.e2.z)", "vec3(l.e1.yz, -l.e2.z)"),
        ("only light samples know beams", PATH, "area_light_le(light_at(s.light), s.front, dot(s.wo, s.n), s.wo)",
         "area_light_le(light_at(s.light), s.front, 1.0, vec3(light_at(s.light).e1.yz, light_at(s.light).e2.z))"),
    ]),
    (CAMERAS, [
        ("an equirectangular picture mirrored", CAMERA, "fract(0.5 * s.x)", "fract(-0.5 * s.x)"),
        ("an equisolid fisheye that is equidistant", CAMERA, "if (CAMERA == CAMERA_FISHEYE) {", "if (true) {"),
        ("light outside of a fisheye's circle", PATH_STATE, "return IS_FISHEYE &&", "return false &&"),
        ("depth along the axis of a panorama", "shaders/kernels/position.comp.glsl", "IS_PANORAMA ? length(away) : ", ""),
        ("a tent that is a box", PIXEL_FILTER, "PIXEL_FILTER == PIXEL_FILTER_TENT", "false"),
        ("a gaussian that ends too late", PIXEL_FILTER, "within = 0.98889100346", "within = 0.999"),
        ("a single step of Newton's method", PIXEL_FILTER, "i < 4u", "i < 1u"),
        ("direct light limited, too", PATH, "bounces < 2u", "bounces < 1u"),
        ("light samples of the second vertex not limited", PATH, "path.depth + 1u)", "path.depth)"),
    ]),
    (SCATTERING, [
        ("distances of one channel weighted for it alone", DISTANCE,
         "dot(share, s.scattered ? extinction * s.weight : s.weight);", "(s.scattered ? hero : 1.0) * exp(-s.t * hero);"),
        ("distances without the density's factor", DISTANCE, "s.scattered ? extinction * s.weight : s.weight", "s.weight"),
        ("vertices for a light not counted", DISTANCE, "if (focus.share > 0.0 && lit) pdf +=", "if (false) pdf +="),
        ("a light that shines everywhere", DISTANCE, "bool lit = s.t >= focus.lit.x && s.t <= focus.lit.y;",
         "bool lit = true;"),
        ("light not scattered but absorbed", DISTANCE, "s.weight *= m.scattering;", "s.weight *= m.absorption;"),
        ("what is scattered not lost from the ray", DISTANCE, "VOLUMETRIC ? m.absorption + m.scattering : m.absorption",
         "m.absorption"),
        ("forwards for backwards", PHASE, "g < 0.0 ? 1.0 : -1.0", "g < 0.0 ? -1.0 : 1.0"),
        ("forwards sampled for backwards", PHASE, "if (g >= 0.0) wi.z = -wi.z;", "if (g < 0.0) wi.z = -wi.z;"),
        ("the phase function normalised for g = 0", PHASE, "(1.0 - a) * (1.0 + a) / (q_squared", "1.0 / (q_squared"),
        ("a cosine at points without a surface", SURFACE, "is_in_medium(x) ? 1.0 : abs(local.z)", "abs(local.z)"),
    ]),
    (SCATTERED_PATHS, [
        ("the medium behind an interface ignored by shadow rays", PATH,
         "shadow.media = media_beyond(shadow.media, x.material.medium, x.s.front);", ""),
        ("shadow rays not dimmed", PATH, "shadow.Ld *= media_transmittance(shadow.media,",
         "vec3 unused = media_transmittance(shadow.media,"),
        ("shadow rays stopped by interfaces", PATH, "if (!surface_is_interface(x)) return false;", "return false;"),
        ("shadow rays that miss their light beyond an interface", PATH, "shadow.ray.d += shadow.ray.o - o;", ""),
        ("the medium behind an interface ignored by paths", PATH,
         "path.media = media_beyond(path.media, x.material.medium, x.s.front);\n    if (WALKS && !x", "if (WALKS && !x"),
        ("the same distances behind an interface", PATH, " | path.crossed << PAIR_CROSSED_SHIFT", ""),
        ("the path's ray traced again while its shadow ray goes on", RENDER, "if (VOLUMETRIC && s.waits) met.hit = s.hit;",
         ""),
        ("a walk that loses nothing", WALK, "path.beta *= way.weight;", ""),
        ("lights found by a walk weighted", WALK, "path.delta = true;  //", "path.delta = false;  //"),
        ("the background seen through what scatters", WALK, "path.clear = false;", ""),
        ("steps of a walk in one direction", WALK, "frame_to_world(frame_from_z(-path.ray.d), scattered.wi)",
         "path.ray.d"),
        ("steps of a walk beyond the solid", RENDER, "if (way.scattered) t_max = way.t;", "if (way.scattered) t_max = 1e-6;"),
        ("a shadow ray traced again after a walk", RENDER, "s.shadow.t_max = 0.0;", ""),
        ("walks beside lights", "host/gpu_scene/nesting.cpp", "std::ranges::any_of(lights, touches)", "false"),
        ("no medium around everything", MATERIAL_ARRAYS, "std::vector<Interior> media{{scene.medium}};",
         "std::vector<Interior> media(1);"),
    ]),
    (INSTANCES, [
        ("what follows an instance traversed in its space", TRAVERSAL, "if (t.node < t.root) {", "if (false) {"),
        ("hits behind an instance belong to it", TRAVERSAL, "t.instance = NO_INSTANCE;\n        t.root = 0u;", "t.root = 0u;"),
        ("children beside an instance's record", TRAVERSAL, "rest = PENDING_NONE;", ""),
        ("the first child taken off where the last was visited", "shaders/scene/stack.glsl",
         "return pending & ~(1u << PENDING_SHIFT << (pending_first(pending) & 31u));",
         "return pending & (pending - (1u << PENDING_SHIFT));"),
        ("rays of an instance not turned", INSTANCE, "vector_to_mesh(i, ray.d))", "ray.d)"),
        ("normals turned as vectors are", INSTANCE, "return n.x * i.to_mesh[0] + n.y * i.to_mesh[1] + n.z * i.to_mesh[2];",
         "return vector_to_scene(i, n);"),
        ("normals of vertices not turned", SMOOTH, "normalize(normal_to_scene(instance, n)) : n", "n : n"),
        ("bitangents of mirrored instances not mirrored", INTERACTION, "instance_determinant(i) < 0.0 ? -t.w : t.w",
         "t.w"),
        ("heights on instances not scaled", BUMP,
         "if (is_instanced(hit.instance)) {", "if (false) {"),
        ("an instance adds nothing to a surface's error", INTERACTION, "inv_length * s.error + i.error",
         "inv_length * s.error"),
        ("a surface's error not scaled by its instance", INTERACTION, "inv_length * s.error + i.error",
         "s.error + i.error"),
        ("boxes of instances without what rays may be off", "shaders/scene/node.glsl", "if (above_instances) margin +=",
         "if (false) margin +="),
        ("boxes of instances without a margin, a little small", INSTANCING, "const dvec3 spare = 2.0 * U *",
         "const dvec3 spare = -64.0 * U *"),
        ("of equal hits of two instances the last one found wins", "shaders/scene/primitive.glsl",
         "before = found.instance < hit.instance;", "before = true;"),
        ("all instances have the same ids", GEOMETRY_ARRAYS, "record.first_id = result.facts.id_count;", "record.first_id = 0;"),
        ("an instance has its mesh's material", "host/gpu_scene/scene_tree.cpp",
         "record.material = shape.material;", "record.material = 0;"),
        ("the stack as deep as the deepest mesh alone", GEOMETRY_ARRAYS, "instance.level + own->second.bvh.depth",
         "own->second.bvh.depth"),
        ("instances in no medium", "host/render/media_at.cpp", "medium_of(instance.material)", "MEDIUM_SAME"),
        ("sheared instances in spaces of their own", INSTANCING, "<= double{MAX_INSTANCE_CONDITION}", "<= 1e30"),
    ]),
    (CHANGES, [
        ("what a change makes again not copied to the device", "host/session/steady_renderer.cpp",
         "*source_.camera, source_.settings, changed);", "*source_.camera, source_.settings);"),
        ("a pose that bends no mesh", "host/scene/scene_change.cpp",
         "if (!is_same(before.meshes[i], now.meshes[i]))", "if (false)"),
    ]),
    (DENOISING, [
        ("noise not taken off differences of light", DENOISE,
         "difference * difference - variance - min(variance, other_variance)", "difference * difference"),
        ("normals' noise taken for edges", DENOISE, "squared(normal.rgb - other.rgb) - noise)",
         "squared(normal.rgb - other.rgb))"),
        ("variance of a weighted mean by the weights themselves", DENOISE, "weight * weight * source_variance.rgb",
         "weight * source_variance.rgb"),
        ("what a pass leaves of the noisy pixel forgotten by the next", DENOISE, "weight * source_variance.a", "weight"),
        ("noise not taken off differences of albedo", SMOOTH_ALBEDO,
         "glm::dot(difference, difference) - a.variance - std::min(a.variance, b.variance)",
         "glm::dot(difference, difference)"),
        ("all of a difference taken for noise", BLEND, "1.0 - belief_.noise_share * sum.noise / sum.square", "0.0"),
        ("few samples believed as many", BLEND, "samples_per_pixel > 0.0 ? samples_per_pixel : UNKNOWN_SAMPLES",
         "UNKNOWN_SAMPLES"),
        ("neighbours that agree not heard", BLEND, "std::max(unexplained[at], agreeing[at])", "unexplained[at]"),
        ("the noisy pixel's share of itself taken for noise", BLEND, "others(i) * variance / level", "variance / level"),
        ("what found nothing believed", BLEND, "Belief{16.0, 1.0,", "Belief{16.0, 0.0,"),
        ("pixels across an edge taken for similar", BLEND, "1.0 - difference * difference * per_range", "1.0"),
        ("an outlier's variance shared by all around it", BLEND, "std::min(variance, VARIANCE_LIMIT * square)", "variance"),
        ("what agrees by chance taken for a bias", BLEND, "sum - CHANCE * std::sqrt(variance)", "sum"),
        ("neighbours that agree in a spot taken for an edge", BLEND, "AGREEING_RADIUS = 3", "AGREEING_RADIUS = 0"),
        ("what one window does not explain taken for an edge", BLEND, "UNEXPLAINED_RADIUS = 1", "UNEXPLAINED_RADIUS = 0"),
        ("lines that end with their strip", BLEND, "STRIP_MARGIN = 2 * AGREEING_RADIUS", "STRIP_MARGIN = 0"),
        ("an outlier takes part in the level around it", DENOISE, "sum += min(value, greatest);", "sum += value;"),
        ("an outlier's own noise not heard", BLEND, "biased + belief_.noise_share * own", "biased"),
        ("a lamp of one pixel taken for an outlier", BLEND, "std::min(share, unexplained_alone(i))", "0.0"),
        ("outliers seen by all around them", "host/denoise/variance.cpp", "16.0f, 1000.0f}", "16.0f, 1e9f}"),
        ("guides without the tint of mirrors", "shaders/integrator/guides.glsl",
         "guides.tint *= clamp(scattered.weight * square(scattered.eta), 0.0, 1.0);", ""),
        ("guides end at the first mirror", "shaders/integrator/guides.glsl", "!bsdf_is_sharp(x.bsdf, uc)", "true"),
        ("merged variances without the difference of means", "host/film/part_sum.cpp",
         "sum.values[i] += difference * difference", "sum.values[i] += 0.0 * difference"),
    ]),
    (DEVICES, [
        ("a work group's counts in the place of those before", PIXEL, "if (n > 0u) atomicAdd(counters[i], n);",
         "if (n > 0u) atomicExchange(counters[i], n);"),
        ("an invocation hands on the work group's counts before all are there", PIXEL,
         "if (atomicAdd(group_finished, 1u) + 1u <", "if (atomicAdd(group_finished, 1u) + 9u <"),
        ("the first array of the scene decides how all are read", "host/render/array_map.cpp",
         "sizes[i] > device.limits", "sizes[0] > device.limits"),
        ("all storage buffers the first one", SCENE_BUFFERS, "storage_[slot], slot)", "storage_[0], slot)"),
        ("arrays that share a storage buffer read from its start", SCENE_BUFFERS,
         "starts[number / 4][int(number % 4)] = start;",
         "starts[number / 4][int(number % 4)] = 0;"),
        ("an exponential of Vulkan's precision", "shaders/base/exponential.glsl", "return e.scale * (1.0 + e.p);",
         "return exp(x);"),
    ]),
]
