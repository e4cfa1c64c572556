# SPDX-License-Identifier: Apache-2.0
"""Faults planted into kernels by tests/cl_shim.cpp, as compilers make them: name -> text, its replacement, and
what `mirrorball blame` must name."""

# Where both the probes and the kernels have all built-in functions declared.
LANES = "typedef union {\n    Reals all;\n    Real lane[RT_LANES];\n} RealLanes;"


def after_lanes(text):
    return LANES, LANES + "\n" + text


ITEM = "    SceneView scene = RT_SCENE_VIEW;\n    add_counts(counts, item, pixels_item"
SAMPLE = "    SceneView scene = RT_SCENE_VIEW;\n    add_counts(counts, item,\n               samples_item"
BRIGHTER = "    scene.params.background.x += (Real)0.25f; scene.params.ambient_light.x += (Real)0.25f;\n"

FAULTS = {
    "fma undone": ("return fma(a.z, b.z, fma(a.y, b.y, a.x * b.x));",
                   "return a.z * b.z + fma(a.y, b.y, a.x * b.x);", "the function dot3"),
    "dot product in another order": ("return fma(a.z, b.z, fma(a.y, b.y, a.x * b.x));",
                                     "return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));",
                                     "the function dot3"),
    "division by a reciprocal": ("return make3(v.x / s, v.y / s, v.z / s);",
                                 "Reals r = (Reals)1 / s; return make3(v.x * r, v.y * r, v.z * r);",
                                 "the function divide3"),
    "square root an ulp off": (*after_lanes(
        "Reals off_by_an_ulp(Reals x) { return sqrt(x) * ((Reals)1 + (Reals)2 * (Reals)RT_ROUNDOFF); }\n"
        "#undef sqrt\n#define sqrt off_by_an_ulp"), "the function square_root"),
    "flushed subnormals": ("return make3(s * v.x, s * v.y, s * v.z);",
                           "v = make3(s * v.x, s * v.y, s * v.z); return make3("
                           "fabs(v.x) < (Reals)1e-37f ? (Reals)0 : v.x, fabs(v.y) < (Reals)1e-37f ? (Reals)0 : v.y, "
                           "fabs(v.z) < (Reals)1e-37f ? (Reals)0 : v.z);", "the function scale3"),
    "a dropped rounding": ("return fma(a, b, -cd) + fma(-c, d, cd);", "return fma(a, b, -cd);",
                           "the function difference_of_products"),
    "fmax returns NaN": ("return a > b ? a : b;", "return a <= b ? b : a;", "the function max_of"),
    "a shift off by one": ("v ^= v >> 11;", "v ^= v >> 12;", "the function hash_bits"),
    "a field elsewhere": ("    Real radius;\n    Index material;", "    Index material;\n    Real radius;",
                          "the function intersect_sphere"),
    "one lane of 16": ("real3 negate3(real3 v) { ", "real3 negate3(real3 v) {\n#if RT_LANES == 16\n"
                       "    v.x.sf += (Real)1;\n#endif\n    ", "the function negate3"),
    "only with glass": (ITEM, ITEM.replace("\n", "\n    if (RT_HAS(GLASS)) {\n" + BRIGHTER + "    }\n", 1),
                        "without glass"),
    "only per sample": (SAMPLE, SAMPLE.replace("\n", "\n" + BRIGHTER, 1), "a sample per work item"),
    "only above 2^20 work items": (*after_lanes(
        "size_t wrapped_id(uint d) { return get_global_id(d) & 0xfffff; }\n"
        "#undef get_global_id\n#define get_global_id wrapped_id"), "more than 2^20 work items"),
}
