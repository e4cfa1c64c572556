# SPDX-License-Identifier: Apache-2.0
"""Small faults, each of which tests must notice: a wrong sign, a forgotten term, a missing check. Those
that take out a guard of the arithmetic are in guards.py.
"""
from trials import Fault as Mutant

K, F, M, S, V = "kernels/", "host/flatten/", "host/measure/", "host/scene/", "host/cli/"
I, J = "host/image/", "host/journal/"


def counts(*filters):
    return [("ray_counts_test", name) for name in filters or ["Scenes/RaysOfScene.*"]]


def cli(test):
    return [("cli", test)]


def edges(test):
    return [("picture_test", "Edges." + test)]


def adaptive(test):
    return [("picture_test", "Adaptive." + test)]


ROUNDS = [("picture_test", "Modes/Rounds.HaveTheSameBitsAndRays*")]


MUTANTS = [
    # Edges
    Mutant("an edges mode does not see shadows", [
        (K + "shade.cl", "sign_lanes(scene, counts, lit, (Indices)(number + 1));", ""),
    ], edges("OpensPixelsAtTheEdgeOfAShadow")),
    Mutant("an edges mode takes parallel planes for one", [
        (K + "signature.cl", " + cell(triangle->plane, (Real)1020.7f)", ""),
    ], edges("OpensPixelsWhereOnePlaneEndsBeforeAnother")),
    Mutant("an edges mode takes each triangle for a surface", [
        (K + "signature.cl", "return (Index)(number * 0x9e3779b1u", "return prim; (void)(number"),
    ], edges("OpensNoPixelsInsideASurface")),
    Mutant("signatures depend on other lanes", [
        (K + "whitted.cl", "sign_lanes(scene, counts, glassy,", "sign_lanes(scene, counts, path->live,"),
    ], ROUNDS),
    Mutant("an edges mode counts the rays of margins", [
        (K + "planes.cl", "used.shadow *= inside;", ""),
    ], ROUNDS),
    Mutant("an edges mode opens edges that do not pay", [
        (K + "edges.cl", "(known == (Reals)8) | (contrast <=", "(known == (Reals)8) & (contrast <="),
    ], edges("LeavesEdgesAlone*")),
    Mutant("an edges mode does not follow thin shapes", [
        (K + "edges.cl", "RT_OPEN | noted_sides(&pixel)", "RT_OPEN"),
    ], edges("FollowsThinShapes*")),
    Mutant("a settled pixel is the mean of its corners", [
        (K + "edges.cl", "sub3(scale3((Reals)(Real)0.25f, sum), change)", "scale3((Reals)(Real)0.25f, sum)"),
    ], edges("SettledPixels*")),
    Mutant("no segment with an edge in it is cut", [
        (K + "lines.cl", "#define RT_JUMP_ERROR ((Real)1 / (Real)12)", "#define RT_JUMP_ERROR ((Real)0)"),
    ], edges("OpenPixelsCover*")),
    Mutant("no lines are added at corners", [
        (K + "lines.cl", "#define RT_BEND_ERROR ((Real)0.0055f)", "#define RT_BEND_ERROR ((Real)0)"),
    ], edges("OpenPixelsCover*")),
    Mutant("cuts go to any segment", [
        (K + "lines.cl", "worst = left[i] > left[worst] ? i : worst;", "worst = more % rated->count;"),
    ], edges("EachDigit*")),
    Mutant("further lines do not look for what their neighbors met", [
        (K + "lines.cl", "Real guess = guess_on(pixel, lines[i]);", "Real guess = (Real)-1;"),
    ], edges("FindsThinTips*")),
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
    ], [("kernel_glass_test", "TraceTree.*")]),
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
    ], [("kernel_sampling_test", "SamplePosition*")]),
    Mutant("Sobol samples alike in all pixels", [
        (K + "sampling.cl", "sobol_position(hash_bits(pixel ^ seed), RT_TO_UINTS(k))",
         "sobol_position(hash_bits((pixel & 0u) ^ seed), RT_TO_UINTS(k))"),
    ], [("kernel_sampling_test", "SobolSample*")]),
    Mutant("Sobol samples alike for all seeds", [
        (K + "sampling.cl", "Uints seed = hash_bits((Uints)(uint)params->seed);",
         "Uints seed = hash_bits((Uints)(uint)(params->seed & 0));"),
    ], [("kernel_sampling_test", "SobolSample*")]),
    Mutant("samples in x where y is meant", [
        (K + "sampling.cl", "position.y = fma(position.y - (Reals)0.5f, side, (Reals)0.5f);",
         "position.y = fma(position.x - (Reals)0.5f, side, (Reals)0.5f);"),
    ], [("kernel_sampling_test", "SamplePosition*")]),
    Mutant("adaptive has one round", [
        (K + "adaptive.cl", "grids = load_row(first_grids + packet.at) > (Reals)1 ? (Indices)0 : grids;",
         "grids = (Indices)0;"),
    ], adaptive("IsComposedOfRegularGrids")),
    Mutant("an adaptive pixel is refined twice", [
        (K + "adaptive.cl", "grids = load_row(first_grids + packet.at) > (Reals)1 ? (Indices)0 : grids;", ""),
    ], adaptive("IsComposedOfRegularGrids")),
    Mutant("adaptive sees beyond the picture", [
        (K + "adaptive.cl", "color = select3(inside, color, own);", ""),
    ], adaptive("*")),
    Mutant("adaptive overlooks a NaN", [
        (K + "adaptive.cl", "return unknown ? (Reals)1 : contrast;", "return contrast;"),
    ], adaptive("IsFinestNearANaN")),
    Mutant("adaptive counts the rays of its margin", [
        (K + "adaptive.cl", "if (in_margin) return;", ""),
    ], ROUNDS),
    # Measuring
    Mutant("bench repeats A A B B", [
        (M + "timing.cpp", "try_once(timed, round == 0, watch);",
         "for (int again = 0; again <= (round == 0 ? repeats : -1); ++again) "
         "try_once(timed, again == 0, watch);"),
    ], [("bench_test.py", "Bench.test_rounds_go_over_all_rows")]),
    Mutant("bench overlooks infinities", [
        (M + "timing.cpp", "run.error->non_finite; count > 0", "run.error->non_finite; count > 1000000"),
    ], cli("measure_cases.Bench.test_a_picture_with_infinities_is_wrong")),
    Mutant("bench overlooks pictures that change", [
        (M + "timing.cpp", "runs->front().image_hash == run.image_hash) continue;",
         "runs->front().image_hash != 0) continue;"),
    ], cli("measure_cases.Bench.test_a_picture_that_changes_between_repeats_is_wrong")),
    Mutant("bench exits 0 with wrong rows", [
        ("host/print/print_run.h", "if (wrong) return", "if (wrong && interrupted) return"),
    ], cli("measure_cases.Bench.test_a_picture_that_is_off_in_a_bit_is_wrong")),
    Mutant("stress ignores differing hashes", [
        ("host/stress/judge.cpp", "if (hashes.size() < 2) continue;", "if (hashes.size() < 200) continue;"),
    ], cli("measure_cases.Stress.test_devices_that_disagree_in_a_bit_fail")),
    Mutant("stress ignores same_bits", [
        ("host/stress/judge.cpp", "if (!trial.same_bits ||", "if (trial.same_bits ||"),
    ], [("host_stress_test", "StressRun.CasesThatShouldHaveTheSameBits*")]),
    Mutant("kernel seconds times 7", [
        ("host/opencl/cl_renderer.cpp", "times_.kernel += kernel;", "times_.kernel += 7 * kernel;"),
    ], cli("stats_cases.Phases.test_kernels_take_most_of_the_trace_time")),
    Mutant("--math fast without its options", [
        ("host/opencl/opencl.cpp", '" -DRT_FAST_MATH=1 -cl-mad-enable"', '""'),
    ], cli("measure_cases.Math.test_fast_lets_the_compiler_contract_and_strict_does_not")),
    Mutant("medians of an even number by the upper one", [
        (M + "timing.cpp", "(values[middle - 1] + values[middle]) / 2", "values[middle]"),
    ], [("host_bench_test", "Statistics.*")]),
    Mutant("Amdahl's law without the serial part", [
        (M + "bench.cpp", "1 / ((1 - parallel_fraction) + parallel_fraction / threads)",
         "1 / (parallel_fraction / threads)"),
    ], [("host_bench_test", "Amdahl.*")]),
    Mutant("Pareto front with points beaten in both", [
        (M + "converge.cpp", "if (!(shown(costs[i].rmse) < best)) continue;",
         "if (!(shown(costs[i].rmse) < 2 * best)) continue;"),
    ], [("host_bench_test", "Pareto.*")]),
    Mutant("RMSE over pixels instead of values", [
        ("host/image/image_error.cpp", "(pixels - error.non_finite) * channels);",
         "(pixels - error.non_finite));"),
    ], cli("compare_cases.Figures.test_numbers")),
    Mutant("the report's trace column shows the slowest", [
        ("python/mirrorball/time_sections.py", "rows.append([*start, milliseconds(trace_seconds(row)),",
         'rows.append([*start, milliseconds(figures["trace"]["max"]),'),
    ], [("report_test.py", "Report.test_the_table_of_every_row_shows_what_its_repeats_give")]),
    # Files
    Mutant("8 bits cut off instead of rounded", [
        ("host/image/encoding.cpp", "(stored * 255.0 + 0.5)",
         "(stored * 255.0)"),
    ], [("host_encoding_test", "Encode8bit.*")]),
    Mutant("OBJ indices from the end are off by one", [
        (S + "obj_file.cpp", "index > 0 ? index - 1 : size + index)",
         "index > 0 ? index - 1 : size + index - 1)"),
    ], [("host_obj_test", "ParseObj.*")]),
    Mutant("NFF lights of half the strength", [
        (S + "nff_file.cpp", "std::sqrt(n) / (2 * n)", "std::sqrt(n) / (4 * n)"),
    ], [("host_nff_test", "ParseNffScene.*")]),
    Mutant("rotations about x the other way", [
        (S + "geometry.cpp", "rotation(degrees.x, 1, 2)", "rotation(degrees.x, 2, 1)"),
    ], [("host_transform_test", "MakeAffine.*")]),
    Mutant("normals turned by the matrix itself", [
        (S + "geometry.cpp",
         "return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};",
         "return m;"),
    ], [("host_transform_test", "*")]),
    Mutant("fov_axis x and y exchanged", [
        (S + "json_file.cpp", '{"x", Fixed::horizontal}, {"y", Fixed::vertical}',
         '{"y", Fixed::horizontal}, {"x", Fixed::vertical}'),
    ], [("host_scene_test", "*")]),
    Mutant("the last column of tiles left out", [
        ("host/render/tile_queue.cpp", "x < region.width; x += tile_width",
         "x + 1 < region.width; x += tile_width"),
    ], [("host_render_test", "MakeTiles.*")]),
    # What is written, kept, limited and checked
    Mutant("pictures are written in place", [
        (I + "output_file.cpp", "destination.in_place = !S_ISREG(status.st_mode);",
         "destination.in_place = true;"),
    ], [("host_output_file_test", "WriteFileAtomically.*")]),
    Mutant("replaced pictures lose their mode", [
        (I + "output_file.cpp", "&& destination_.existing) {", "&& false) {"),
    ], [("host_output_file_test", "WriteFileAtomically.*")]),
    Mutant("an output may be an input", [
        (I + "output_file.cpp", "names_.find(identity(output))",
         "names_.find(output)"),
    ], [("host_output_file_test", "OutputPath.*")]),
    Mutant("a small PNG may promise a huge picture", [
        (I + "built_in_formats.cpp", "picture.pixels.reserve(values * picture.height);",
         "picture.pixels.resize(values * picture.height), picture.pixels.clear();"),
    ], [("host_picture_read_test", "ReadPicture.PngThatPromises*")]),
    Mutant("PLY indices past the end pass", [
        (S + "ply_file.cpp", "index < static_cast<double>(all.size())",
         "index <= static_cast<double>(all.size())"),
    ], [("host_ply_test", "ParsePly.BadFiles*")]),
    Mutant("buffers may exceed the free memory", [
        ("host/base/memory.cpp", "if (bytes <= free.bytes) return;",
         "if (bytes > 0 || bytes <= free.bytes) return;"),
    ], [("host_memory_test", "CheckMemory.*")]),
    Mutant("journals without checksums", [
        (J + "journal_format.cpp", "if (record_crc(kind_, body_) != head.crc) return false;", ""),
    ], [("host_journal_test", "Journals.*")]),
    Mutant("a resumed picture takes another picture's journal", [
        ("host/picture/picture_journal.h", "is_ours_ = header.key == header_.key;", "is_ours_ = true;"),
    ], [("host_journal_test", "Journals.*")]),
    Mutant("two processes write one journal", [
        (J + "journal_file.cpp", "::flock(file.number(), LOCK_EX | LOCK_NB) != 0 && ", "false && "),
    ], [("host_journal_test", "Journals.*")]),
    Mutant("merge takes parts of other pictures", [
        (J + "shares.cpp", "is_same = header.key == first.key && ", "is_same = "),
    ], cli("journal_cases.Shares.test_parts_that_are_none_are_refused")),
    Mutant("merge overlooks pixels that differ", [
        (J + "shares.cpp", "values, pixel_bytes) != 0) {", "values, pixel_bytes) > 999) {"),
    ], [("host_journal_test", "Journals.*")]),
    Mutant("merge forgets that pixels are missing", [
        (J + "shares.cpp", "if (merged.missing_pixels > 0) merged",
         "if (merged.missing_pixels > 9999999) merged"),
    ], cli("journal_cases.Shares.test_that_are_missing_are_named")),
    Mutant("the self-test of a device always passes", [
        ("host/picture/crew.cpp", "if (wrong == 0 && rays == right_rays)", "if (wrong < 9999)"),
    ], cli("wrong_cases.Wrong.test_by_its_self_test")),
    Mutant("--check compares tiles with themselves", [
        ("host/picture/crew.cpp", "differing_pixels(again, part_of(film",
         "differing_pixels(part_of(film, region, tile), part_of(film"),
    ], cli("wrong_cases.Wrong.test_by_tracing_tiles_again")),
    Mutant("a driver that crashes while it is listed is not left out", [
        ("host/process/drivers.cpp", "end.task == listing_devices", "end.task.empty()"),
    ], cli("dies_cases.Dies.test_is_left_out_of_what_is_measured")),
    Mutant("NaN in a picture is no error", [
        (V + "save_picture.cpp", "if (non_finite) return", "if (non_finite && false) return"),
    ], cli("picture_cases.NotFinite.test_on_every_device")),
]
