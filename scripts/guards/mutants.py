# SPDX-License-Identifier: Apache-2.0
"""Small faults, each of which some test must notice: a wrong sign, a forgotten term, a missing check.
Faults that remove a guard of the arithmetic are in guards.py instead.
"""
import dataclasses

K, F, M, S, V = "kernels/", "host/flatten/", "host/measure/", "host/scene/", "host/verbs/"


@dataclasses.dataclass
class Mutant:
    """`edits`: (file, text that stands in it once, text in its place). `tests`: a file's tests or a
    test program's with a filter, or "stress" with cases, or "cli" or a FILE.py with a test's name;
    one of them must fail."""
    name: str
    edits: list
    tests: list


def counts(*filters):
    return [("ray_counts_test", name) for name in filters or ["Scenes/RaysOfScene.*"]]


def driver(test):
    return [("wrong_driver_test.py", test)]


MUTANTS = [
    # Rays and shading
    Mutant("paths go on when they are black", [
        (K + "whitted.cl", "path->live &= !is_black(reflected);", "path->live &= path->live;"),
    ], counts()),
    Mutant("branches too faint to matter are followed", [
        (K + "whitted.cl", "return !(largest >= (Reals)(Real)RT_ROUNDOFF);",
         "return !(largest >= (Reals)0);"),
    ], counts("Scenes/RaysOfScene.*glass")),
    Mutant("one bounce too many", [
        (K + "whitted.cl", "path->bounce >= scene->params.max_bounces;",
         "path->bounce > scene->params.max_bounces;"),
    ], counts()),
    Mutant("shadow rays of lights behind the surface", [
        (K + "shade.cl", "lit &= cosine > (Reals)0;", "lit &= cosine > (Reals)-2;"),
    ], counts()),
    Mutant("index of refraction inverted", [
        (K + "whitted.cl", "Reals eta = inside ? material->ior : (Reals)1 / material->ior;",
         "Reals eta = inside ? (Reals)1 / material->ior : material->ior;"),
    ], [("kernel_glass_test", "TraceTree.*"), *counts("Scenes/RaysOfScene.*glass")]),
    Mutant("total reflection loses the transmitted weight", [
        (K + "whitted.cl", "select3(total, limit3(add3(reflected, transmitted)), reflected);",
         "select3(total, limit3(reflected), reflected);"),
    ], [("kernel_glass_test", "TraceTree.*")]),
    Mutant("two-sided surfaces are not turned", [
        (K + "whitted.cl", "Mask turned = (material.two_sided != 0) & inside;",
         "Mask turned = (material.two_sided != 0) & inside & RT_NO_LANES;"),
    ], counts("Scenes/RaysOfScene.*two_sided")),
    Mutant("vertex normals exchanged", [
        (K + "surface.cl", "blend = add_scaled(blend, v, load3(normals->n2));",
         "blend = add_scaled(blend, v, load3(normals->n1));"),
    ], [("kernel_surface_test", "BlendedNormal.*")]),
    Mutant("half vector without the eye", [
        (K + "shade.cl", "real3 sum = add3(to_light, to_eye);",
         "real3 sum = add3(to_light, to_light);"),
    ], [("kernel_shade_test", "SpecularLobe.*")]),
    # Samples
    Mutant("a filter's weight without y", [
        (K + "sampling.cl", "filter_weight(params->filter, position.y - (Reals)0.5f);",
         "filter_weight(params->filter, (Reals)0);"),
    ], [("kernel_filter_test", "SampleWeight*")]),
    Mutant("Sobol samples alike in all pixels", [
        (K + "sampling.cl", "sobol_position(hash_bits(pixel ^ seed), RT_TO_UINTS(k))",
         "sobol_position(hash_bits((pixel & 0u) ^ seed), RT_TO_UINTS(k))"),
    ], [("kernel_filter_test", "SobolSample*")]),
    Mutant("Sobol samples alike for all seeds", [
        (K + "sampling.cl", "Uints seed = hash_bits((Uints)(uint)params->seed);",
         "Uints seed = hash_bits((Uints)(uint)(params->seed & 0));"),
    ], [("kernel_filter_test", "SobolSample*")]),
    Mutant("samples in x where y is meant", [
        (K + "sampling.cl", "position.y = fma(position.y - (Reals)0.5f, side, (Reals)0.5f);",
         "position.y = fma(position.x - (Reals)0.5f, side, (Reals)0.5f);"),
    ], [("kernel_sampling_test", "SamplePosition*"), ("picture_test", "AaModes/*")]),
    Mutant("one refining pass", [
        ("host/render/picture_loop.h", "refine_passes = 2;", "refine_passes = 1;"),
    ], [("host_refine_test", "RenderAll.*")]),
    Mutant("three refining passes", [
        ("host/render/picture_loop.h", "refine_passes = 2;", "refine_passes = 3;"),
    ], [("host_refine_test", "RenderAll.*")]),
    # Measuring
    Mutant("bench repeats A A B B", [
        (V + "timing_loop.cpp", "try_once(timed, round == 0, watch);",
         "for (int again = 0; again <= (round == 0 ? repeats : -1); ++again) "
         "try_once(timed, again == 0, watch);"),
    ], [("bench_test.py", "Bench.test_rounds_go_over_all_rows")]),
    Mutant("bench ignores its judge", [
        (V + "timing_loop.cpp",
         "judgment.why_wrong.empty() ? what_differs(timed, run) : judgment.why_wrong;",
         "what_differs(timed, run);"),
    ], driver("Bench.test_a_picture_far_from_the_reference_is_wrong")),
    Mutant("bench overlooks pictures that change", [
        (V + "timing_loop.cpp", "runs->front().image_hash == run.image_hash) continue;",
         "runs->front().image_hash != 0) continue;"),
    ], driver("Bench.test_a_picture_that_changes_between_repeats_is_wrong")),
    Mutant("bench exits 0 with wrong rows", [
        (V + "bench.cpp", "slower || any_row(result, Verdict::wrong)", "slower"),
    ], driver("Bench.test_a_picture_far_from_the_reference_is_wrong")),
    Mutant("stress ignores differing hashes", [
        (V + "stress_run.cpp", "if (hashes.size() < 2) continue;",
         "if (hashes.size() < 200) continue;"),
    ], driver("Stress.test_devices_that_disagree_in_a_bit_fail")),
    Mutant("stress ignores same_bits", [
        (V + "stress_run.cpp", "if (!is_new && first->second != row.hash) {",
         "if (is_new && first->second != row.hash) {"),
    ], driver("Stress.test_cases_that_should_have_the_same_bits_and_do_not_fail")),
    Mutant("kernel seconds times 7", [
        ("host/opencl/cl_renderer.cpp", "times_.kernel += kernel;", "times_.kernel += 7 * kernel;"),
    ], [("cli", "stats_cases.Phases.test_kernels_take_most_of_the_trace_time")]),
    Mutant("--math fast without its options", [
        ("host/opencl/cl_program.cpp", '" -DRT_FAST_MATH=1 -cl-mad-enable"', '""'),
    ], driver("Math.test_fast_lets_the_compiler_contract")),
    Mutant("medians of an even number by the upper one", [
        (M + "statistics.cpp", "(values[middle - 1] + values[middle]) / 2", "values[middle]"),
    ], [("host_bench_test", "Statistics.*")]),
    Mutant("Amdahl's law without the serial part", [
        (M + "amdahl.cpp", "1 / ((1 - parallel_fraction) + parallel_fraction / threads)",
         "1 / (parallel_fraction / threads)"),
    ], [("host_bench_test", "Amdahl.*")]),
    Mutant("regressions without regard to noise", [
        (M + "baseline.cpp", "now.median - before.median > 3 * (before.mad + now.mad)",
         "now.median > before.median"),
    ], [("host_bench_test", "Baseline.*")]),
    Mutant("Pareto front with points beaten in both", [
        (M + "pareto.cpp", "if (!(costs[i].rmse < best)) continue;",
         "if (!(costs[i].rmse < 2 * best)) continue;"),
    ], [("host_bench_test", "Pareto.*")]),
    Mutant("RMSE over pixels instead of values", [
        ("host/image/image_error.cpp", "(pixels - error.non_finite) * channels);",
         "(pixels - error.non_finite));"),
    ], [("host_compare_test", "ImageError.*")]),
    Mutant("shifted pictures pass", [
        (M + "picture_judge.cpp", "if (mse < best) {", "if (mse < 0) {"),
    ], [("host_bench_test", "JudgePicture.*")]),
    Mutant("the report's trace column shows the slowest", [
        ("host/report/timing_section.cpp", 'cells.push_back({milliseconds(figures.trace.median), ""});',
         'cells.push_back({milliseconds(figures.trace.max), ""});'),
    ], [("report_test.py", "Report.test_the_table_of_every_row_shows_what_its_repeats_give")]),
    # Files
    Mutant("8 bits cut off instead of rounded", [
        ("host/image/encoding.cpp", "(stored * 255.0 + 0.5)",
         "(stored * 255.0)"),
    ], [("host_encoding_test", "Encode8bit.*")]),
    Mutant("OBJ indices from the end are off by one", [
        (S + "obj_chunk.cpp", "index > 0 ? index - 1 : size + index)",
         "index > 0 ? index - 1 : size + index - 1)"),
    ], [("host_obj_test", "ParseObj.*")]),
    Mutant("NFF lights of half the strength", [
        (S + "nff_file.cpp", "std::sqrt(n) / (2 * n)", "std::sqrt(n) / (4 * n)"),
    ], [("host_nff_test", "ParseNffScene.*")]),
    Mutant("rotations about x the other way", [
        (S + "affine.cpp", "rotation(degrees.x, 1, 2)", "rotation(degrees.x, 2, 1)"),
    ], [("host_transform_test", "MakeAffine.*")]),
    Mutant("normals turned by the matrix itself", [
        (S + "affine.cpp",
         "return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};",
         "return m;"),
    ], [("host_transform_test", "*")]),
    Mutant("fov_axis x and y exchanged", [
        (S + "json_camera.cpp", "*is_x ? Fixed::horizontal : Fixed::vertical",
         "*is_x ? Fixed::vertical : Fixed::horizontal"),
    ], [("host_scene_test", "*")]),
    Mutant("the last column of tiles left out", [
        ("host/render/tile_queue.cpp", "x < region.width; x += tile_width",
         "x + 1 < region.width; x += tile_width"),
    ], [("host_render_test", "MakeTiles.*")]),
]
