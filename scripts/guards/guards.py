# SPDX-License-Identifier: Apache-2.0
"""The guards of the arithmetic: where each one is in the kernels or in the host, how to remove it, and the
tests that must then fail.
"""
from trials import Fault as Guard

K, F = "kernels/", "host/flatten/"

GUARDS = [
    Guard("coordinates are rounded after they are moved to the eye", [
        (F + "view_frame.h", "return (scene_point - eye) * scale;",
         "return (glm::dvec3(glm::vec3(scene_point)) - glm::dvec3(glm::vec3(eye))) * scale;"),
    ], [("invariance_test", "MovedScene.Shifted*")]),
    Guard("lengths are scaled to about 1", [
        (F + "view_frame.cpp", "frame.scale = std::ldexp(1.0, -octaves.median());",
         "frame.scale = 1;"),
    ], [("invariance_test", "MovedScene.ScaledByAPowerOfTen*")]),
    Guard("a flat triangle is skipped by rays that leave it", [
        (K + "closest_hit.cl", "met &= ray->from != prim;", ""),
        (K + "closest_hit.cl", " & (ray->from != prim)", ""),
    ], [("kernel_scene_test", "ClosestHit.SkipsTheTriangle*"),
        ("kernel_scene_test", "AnyHit.SkipsTheTriangle*")]),
    Guard("a ray from a sphere carries its chord", [
        (K + "intersect.cl", "Mask leaving = ray->from == prim;", "Mask leaving = RT_NO_LANES;"),
    ], [("kernel_intersect_test", "IntersectSphere.LeavingItRunsAlongTheChord"),
        ("stress", "leaving-sphere/1,leaving-far-sphere/1")]),
    Guard("rays start a bounded distance off the surface", [
        (K + "hit_surface.cl", "behind ? -surface->offset : surface->offset",
         "behind ? (Reals)-0.0f : (Reals)0"),
    ], [("kernel_surface_test", "OffsetOrigin.*:TriangleSurface.LiesWithin*")]),
    Guard("and one ulp further", [
        (K + "hit_surface.cl",
         "return make3(one_ulp_towards(p.x, step.x), one_ulp_towards(p.y, step.y),\n"
         "                 one_ulp_towards(p.z, step.z));", "return p;"),
    ], [("kernel_surface_test", "OffsetOrigin.*:TriangleSurface.LiesWithin*")]),
    Guard("points near an edge move clear of the neighbor", [
        (K + "hit_surface.cl", "live & (hit->tied | is_on_edge(scene, hit))", "live & hit->tied"),
    ], [("kernel_surface_test", "SurfaceAt.*")]),
    Guard("and into their triangle", [
        (K + "hit_surface.cl", "surface.point = select3(lanes, clear, surface.point);", ""),
    ], [("kernel_surface_test", "SurfaceAt.*"),
        ("geometry_touching_test", "Touching.MirrorsThatMeet*"),
        ("host_stress_test", "LeavingEdges.*")]),
    Guard("rays that start in a triangle's plane do not meet it", [
        (K + "intersect.cl", "fabs(height) <= error ? (Reals)0 : height", "height"),
    ], [("stress", "leaving-edges/ball-outside")]),
    Guard("points on several surfaces move clear of them", [
        (K + "hit_surface.cl", "live & (hit->tied | is_on_edge(scene, hit))",
         "live & is_on_edge(scene, hit)"),
    ], [("kernel_surface_test", "SurfaceAt.*"), ("stress", "ties")]),
    Guard("and by what a tie may hide", [
        (K + "hit_surface.cl", "(hit->tied ? tie : (Reals)0)", "(Reals)0"),
    ], [("kernel_surface_test", "SurfaceAt.*")]),
    Guard("pixels are square to the last bit", [
        (F + "view_frame.cpp", "return {x, x};", "return {x, y};"),
        (F + "view_frame.cpp", "return {y, y};", "return {x, y};"),
    ], [("host_frame_test", "FlattenFrame.HasPixels*")]),
    Guard("sphere: D from the closest approach", [
        (K + "intersect.cl",
         "Reals discriminant = (Reals)(sphere->radius * sphere->radius) - dot3(l, l);",
         "Reals discriminant = b * b - (dot3(f, f) - (Reals)(sphere->radius * sphere->radius));"),
    ], [("kernel_intersect_test", "IntersectSphere.IsRightAt*"),
        ("stress", "sphere-size,sphere-rays")]),
    Guard("sphere: the normal from closest approach and half chord", [
        (K + "surface.cl", "return normalize3(add_scaled(l, t < b ? -s : s, ray->dir));",
         "return normalize3(add_scaled(f, t, ray->dir));"),
    ], [("kernel_surface_test", "SphereSurface.*")]),
    Guard("sphere: what rounding took from its center", [
        (K + "surface.cl", "l = sub3(l, load3(sphere->center_low));", ""),
    ], [("kernel_surface_test", "SphereSurface.*")]),
    Guard("sphere: what rounding took from the eye ray", [
        (K + "camera.cl", "ray.dir_low = add_scaled(add_scaled(negate3(ray.dir), inverse, "
         "through), inverse, low);", ""),
    ], [("kernel_camera_test", "CameraRay.*")]),
    Guard("sphere: what rounding took from the point left", [
        (K + "hit_surface.cl",
         "ray.origin_low = add3(sub3(surface->point, origin), surface->point_low);",
         "ray.origin_low = ray.dir_low;"),
    ], [("kernel_surface_test", "SpawnRay.*")]),
    Guard("a huge sphere by its power", [
        (F + "flat_shapes.h", "flat.is_huge = is_huge(radius, distance) ? 1 : 0;",
         "flat.is_huge = 0;"),
    ], [("stress", "huge-ball-floor")]),
    Guard("the point of a huge sphere is not put back", [
        (K + "surface.cl", "if (RT_HAS(HUGE_SPHERES) && sphere->is_huge != 0) {", "if (false) {"),
    ], [("stress", "huge-ball-floor")]),
    Guard("cone: moved to the closest approach", [
        (K + "cone.cl", "leaving ? (Reals)0 : cone_shift(ray, w, goal, cone);", "(Reals)0;"),
    ], [("kernel_cone_test", "IntersectCone.IsRight*")]),
    Guard("cone: cross products by differences of products", [
        (K + "cone.cl",
         "return make3(difference_of_products(a.y, b.z, a.z, b.y),\n"
         "                 difference_of_products(a.z, b.x, a.x, b.z),\n"
         "                 difference_of_products(a.x, b.y, a.y, b.x));",
         "return make3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);"),
    ], [("kernel_cone_test", "Cross3.*")]),
    Guard("a ray from a cone carries its chord", [
        (K + "cone.cl", "leaving ? self_hit : -(b", "leaving ? (Reals)-2 * b : -(b"),
    ], [("kernel_cone_test", "IntersectCone.Leaving*")]),
    Guard("refraction by the tangential part of the direction", [
        (K + "whitted.cl", "Reals sine = dot3(along, along);",
         "Reals sine = (Reals)1 - cosine * cosine;"),
    ], [("kernel_glass_test", "RefractedRay.ObeysSnell")]),
    Guard("index of refraction 1 leaves the direction alone", [
        (K + "whitted.cl", "select3(eta == (Reals)1, dir, normalize3(bent))", "normalize3(bent)"),
    ], [("kernel_glass_test", "RefractedRay.GoesStraightOn*")]),
    Guard("refracted rays cross the face", [
        (K + "whitted.cl", "attempt == 1 ||", "attempt == 0 ||"),
    ], [("kernel_glass_test", "RefractedRay.CrossesTheFace*")]),
    Guard("triangle: edge functions by differences of products", [
        (K + "math.cl", "return fma(a, b, -cd) + fma(-c, d, cd);", "return a * b - cd;"),
    ], [("kernel_math_test", "DifferenceOfProducts.*")]),
    Guard("triangle: both products of an edge function round alike", [
        (K + "math.cl", "return fma(a, b, -cd) + fma(-c, d, cd);", "return fma(a, b, -cd);"),
    ], [("kernel_leak_test", "ClosedMesh.*")]),
    Guard("triangle: the point from its weights", [
        (K + "surface.cl",
         "surface.point = add_scaled(surface.point, hit->v, sub3(load3(triangle->p2), p0));",
         "surface.point = add_scaled(ray->origin, hit->t, ray->dir);"),
    ], [("kernel_surface_test", "TriangleSurface.LiesWithin*")]),
    Guard("triangle: the point projected where it is large", [
        (K + "surface.cl", "largest_coordinate(triangle) > (Reals)8 * distance",
         "largest_coordinate(triangle) > (Reals)INFINITY"),
    ], [("kernel_surface_test", "TriangleSurface.OnAWall*"), ("stress", "huge-triangle")]),
    Guard("triangle: t from the plane where it is large", [
        (K + "intersect.cl", "((reach > (Reals)8 * fabs(*t)) | ", "("),
    ], [("stress", "huge-triangle")]),
    Guard("shadow rays end before the light", [
        (K + "shade.cl", "distance * (Reals)((Real)1 - (Real)16 * (Real)RT_ROUNDOFF)", "distance"),
    ], [("stress", "light-place")]),
    Guard("a surface does not block a light on it", [
        (K + "intersect.cl", "return near & is_nearest ? crosses : t <= t_max;", "return t <= t_max;"),
    ], [("kernel_scene_test", "AnyHit.OfThe*"), ("stress", "light-place")]),
    Guard("but one next to it, on the other side", [
        (K + "intersect.cl", "side == RT_OUTSIDE ? outwards : RT_NO_LANES;", "RT_NO_LANES;"),
        (K + "intersect.cl", "return near ? !outwards : t <= t_max;", "return t <= t_max;"),
    ], [("stress", "light-place")]),
    Guard("at a cone's tip both roots are the light", [
        (K + "cone.cl", "!roots.is_far_outwards, is_tip | ", "!roots.is_far_outwards, "),
        (K + "cone.cl", "roots.is_far_outwards, is_tip | leaving", "roots.is_far_outwards, leaving"),
    ], [("stress", "light-place")]),
    Guard("an eye next to a cone is on its own side", [
        (F + "flat_shapes.h", "constexpr double eye_ulps = 8;", "constexpr double eye_ulps = 0;"),
    ], [("stress", "eye-place")]),
    Guard("an eye on a surface starts by leaving it", [
        (F + "flat_scene.cpp", "eye_is_on_surface() ? 1 : 0", "0"),
    ], [("stress", "eye-on-surface")]),
    Guard("mirrors' product stays finite", [
        (K + "math.cl", "return make3(limited(v.x), limited(v.y), limited(v.z));", "return v;"),
    ], [("stress", "bright-mirrors")]),
    Guard("boxes are enlarged", [
        (F + "flat_shapes.h", "T(box_slack) * Flat<T>::roundoff", "T(0) * Flat<T>::roundoff"),
    ], [("geometry_hits_test", "Hits.*"), ("kernel_hits_test", "DeviceHits.*")]),
    Guard("and by the origin's share", [
        (K + "bvh.cl", "(Reals)((Real)16 * (Real)RT_ROUNDOFF) * max_of", "(Reals)0 * max_of"),
    ], [("geometry_hits_test", "Hits.*FromFarAway")]),
    Guard("Blinn lobe near its peak from the part across the normal", [
        (K + "power.cl", "Mask near = (binades >= (Indices)0) & !low;",
         "Mask near = (binades > (Indices)0) & !low;"),
    ], [("kernel_power_test", "Log2Cosine.*:BlinnLobe.IsThePower*"), ("stress", "highlight")]),
    Guard("ties go to the first in the scene", [
        (K + "closest_hit.cl", "if (search.finds_first || !any_lane(tied)) break;", "break;"),
    ], [("kernel_scene_test", "ClosestHit.*"), ("stress", "ties")]),
    Guard("surfaces within 32 u are one", [
        (K + "scene_view.h", "#define RT_TIE ((Real)32 * (Real)RT_ROUNDOFF)", "#define RT_TIE ((Real)0)"),
    ], [("kernel_scene_test", "ClosestHit.*"), ("stress", "ties")]),
    Guard("behind glass more surfaces are one", [
        (K + "closest_hit.cl", "behind = (Reals)2 * surface.offset / sine", "behind = (Reals)0"),
    ], [("geometry_touching_test", "Touching.*")]),
    Guard("points of ties stay in front of what their ray left", [
        (K + "hit_surface.cl", "back = min_of(back, (Reals)0.5f * hit->t);", ""),
    ], [("kernel_surface_test", "SurfaceAt.*")]),
    Guard("and for short rays of the origin's distance, too", [
        (K + "search.cl", " + search->slack;", ";"),
    ], [("kernel_scene_test", "ClosestHit.*")]),
    Guard("a smooth mirror never reflects under its face", [
        (K + "whitted.cl", "mirrored = select3(leaves, mirrored, reflect3(dir, "
         "surface->geometric));", "mirrored = select3(leaves, mirrored, mirrored);"),
    ], [("kernel_whitted_test", "MirrorRay.LeavesOn*"), ("stress", "smooth-mesh")]),
    Guard("vertex normals that cancel give way to the face's", [
        (K + "surface.cl", "squared > (Reals)0x1p-40f,", "squared >= (Reals)0,"),
    ], [("kernel_surface_test", "BlendedNormal.*")]),
    Guard("`-fno-tree-slp-vectorize`", [
        ("tests/CMakeLists.txt", "# add_python_test(",
         "set_source_files_properties(compiler_test.cpp PROPERTIES COMPILE_OPTIONS "
         "\"-O2;-ftree-slp-vectorize\")\n# add_python_test("),
    ], [("compiler_test", "Compiler.Rounds*")]),
    Guard("`-fno-ivopts`", [
        ("tests/CMakeLists.txt", "# add_python_test(",
         "set_source_files_properties(compiler_test.cpp PROPERTIES COMPILE_OPTIONS "
         "\"-O2;-fivopts;-march=skylake-avx512\")\n# add_python_test("),
    ], [("compiler_test", "Compiler.Keeps*")]),
    Guard("`-ffp-contract=off`", [
        ("tests/CMakeLists.txt", "# add_python_test(",
         "set_source_files_properties(compiler_test.cpp PROPERTIES COMPILE_OPTIONS "
         "\"-O2;-ffp-contract=fast;-mfma\")\n# add_python_test("),
    ], [("compiler_test", "Compiler.DoesNotContract")]),
    Guard("`FP_CONTRACT OFF`", [
        (K + "types.h", "#pragma OPENCL FP_CONTRACT OFF", "#pragma OPENCL FP_CONTRACT ON"),
    ], [("kernel_math_test", "Contraction.*")]),
    Guard("pictures are searched for NaN: stress", [
        ("host/stress/reference.cpp", "std::isnan(change.x + change.y + change.z)", "false"),
    ], [("host_stress_test", "StressJudge.*")]),
    Guard("pictures are searched for NaN: render", [
        ("host/cli/save_picture.cpp", "if (count == 0) return false;", "if (count + 1 > 0) return "
         "false;"),
    ], [("cli", "render_cases.NonFinite")]),
    Guard("triangle: the normal of a thin one without cancellation", [
        (F + "triangle_list.cpp", "< 0x1p-8 * glm::dot(a, a)", "< 0 * glm::dot(a, a)"),
    ], [("stress", "long-triangle/1e+08")]),
    Guard("samples are added in partial sums", [
        (K + "packet.cl", "#define RT_PARTIAL_SUM 256", "#define RT_PARTIAL_SUM 4096"),
    ], [("kernel_whitted_test", "TracePixel*Drift*")]),
    Guard("a chord does not start at a point that has moved", [
        (K + "whitted.cl", "Mask moved = (glassy | inside) &", "Mask moved = glassy &"),
    ], [("geometry_touching_test", "Touching*SmallerThanRounding*")]),
    Guard("a tiny index of refraction is not 0", [
        (F + "flat_shapes.h", "std::numeric_limits<T>::min()", "T(0)"),
    ], [("geometry_touching_test", "Touching*HeadOn*")]),
    Guard("hierarchies are no deeper than a traversal's stack", [
        (F + "bvh_split.cpp", "range.depth + halvings >= max_bvh_depth",
         "range.depth + halvings >= 1 << 20"),
    ], [("geometry_bvh_test", "*")]),
    Guard("ray trees are no deeper than their stack", [
        (F + "flat_scene.cpp", "if (scene_.max_bounces <= f32::RT_TREE_STACK || "
         "!material_use_.splits) return;",
         "if (scene_.max_bounces < 1 << 30 || !material_use_.splits) return;"),
    ], [("features_test", "Flatten.Refuses*")]),
]
