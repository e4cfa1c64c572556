// SPDX-License-Identifier: Apache-2.0
#include "host/verbs/converge_reference.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <vector>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/hash.h"
#include "host/image/atomic_file.h"
#include "host/image/image_error.h"
#include "host/image/input_file.h"
#include "host/image/picture_io.h"
#include "host/measure/picture_judge.h"
#include "host/render/stopwatch.h"
#include "host/scene/scene_hash.h"
#include "host/verbs/timing_loop.h"

namespace rt {

namespace {

/// A hash of the program file: a Git revision would not tell uncommitted edits apart. Empty if it
/// cannot be read.
std::optional<std::uint64_t> program_hash() {
    std::ifstream file("/proc/self/exe", std::ios::binary);
    Hasher hasher;
    std::vector<char> piece(1 << 20);
    while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())) ||
           file.gcount() > 0) {
        const auto count = static_cast<std::size_t>(file.gcount());
        hasher.add_bytes(std::as_bytes(std::span(piece.data(), count)));
    }
    if (!file.eof()) return std::nullopt;
    return hasher.value();
}

/// The cache file of a half, named by hashes of all it depends on, this program included.
std::string cache_path(const std::string& folder, const Scene& scene) {
    static const std::optional<std::uint64_t> program = program_hash();
    if (folder.empty() || !program) return "";
    Hasher settings;
    settings.add(std::string_view("reference 2"));
    settings.add(*program);
    settings.add(scene.width);
    settings.add(scene.height);
    settings.add(scene.max_bounces);
    settings.add(std::string_view(to_string(scene.aa)));
    settings.add(std::string_view(to_string(scene.filter)));
    settings.add(scene.sampling_seed);
    return fmt::format("{}/{}-{}.pfm", folder, hash_text(scene_hash(scene)),
                       hash_text(settings.value()));
}

std::uint64_t hash_of(const Picture& picture) {
    Hasher hasher;
    hasher.add_bytes(std::as_bytes(std::span(picture.pixels)));
    return hasher.value();
}

/// Beside a cached half: the hash of its pixels.
std::string hash_path(const std::string& path) { return path + ".hash"; }

/// Empty if the file is missing or damaged.
std::optional<Picture> read_half(const std::string& path, const Scene& scene) {
    std::error_code ignored;
    if (path.empty() || !std::filesystem::exists(path, ignored)) return std::nullopt;
    try {
        Picture half = read_picture(path);
        std::string hash;
        open_input_file(hash_path(path)).stream >> hash;
        const bool fits =
            half.width == scene.width && half.height == scene.height && half.channels == 3;
        if (fits && hash == hash_text(hash_of(half))) return half;
    } catch (const Error&) {
    }
    print_note(path + ": the cached reference is damaged; rendering it again");
    return std::nullopt;
}

void keep_half(const std::string& path, const Picture& half) {
    try {
        std::error_code ignored;
        std::filesystem::create_directories(std::filesystem::path(path).parent_path(), ignored);
        write_picture(path, half, Encoding::display);
        const std::string hash = hash_text(hash_of(half));
        write_file_atomically(hash_path(path), std::as_bytes(std::span(hash)));
    } catch (const Error& error) {
        print_note(fmt::format("the reference is not cached: {}", error.what()));
    }
}

struct Half {
    Picture picture;
    std::string path;
    bool from_cache = false, complete = true;
};

/// A half is sampled with a seed that no timed picture has.
Half make_half(Scene scene, int seed, const ConvergeOptions& options) {
    scene.aa = *parse_aa_mode(fmt::format("sobol:{}", options.reference_samples));
    scene.sampling_seed = seed;
    Half half;
    half.path = cache_path(options.cache_folder, scene);
    if (auto kept = read_half(half.path, scene)) {
        half.picture = std::move(*kept);
        half.from_cache = true;
        return half;
    }
    if (!options.quiet) {
        print_note(fmt::format("rendering half {} of the reference, {} in double", seed,
                               to_string(scene.aa)));
    }
    RenderSettings settings = timed_settings();
    settings.precision = Precision::float64;
    RenderedPicture rendered = render_quietly(scene, settings, threads_choice());
    half.complete = rendered.stats.complete();
    half.picture = std::move(rendered.picture);
    if (half.complete && !half.path.empty() && count_non_finite(half.picture) == 0) {
        keep_half(half.path, half.picture);
    }
    return half;
}

Picture mean_of(const Picture& a, const Picture& b) {
    Picture mean = a;
    for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
        mean.pixels[i] = static_cast<float>((double{a.pixels[i]} + double{b.pixels[i]}) / 2);
    }
    return mean;
}

}  // namespace

ConvergedPicture converged_picture(const Scene& scene, const ConvergeOptions& options) {
    const Stopwatch watch;
    const Half a = make_half(scene, 1, options);
    ConvergedPicture converged;
    converged.complete = a.complete;
    if (!a.complete) return converged;
    const Half b = make_half(scene, 2, options);
    converged.complete = b.complete;
    if (!b.complete) return converged;
    if (count_non_finite(a.picture) + count_non_finite(b.picture) > 0) {
        throw Error(ExitCode::non_finite,
                    "the reference has pixels that are not finite; look for very large numbers in "
                    "the scene");
    }
    ConvergeReference& about = converged.about;
    about.aa_a = fmt::format("sobol:{} seed 1", options.reference_samples);
    about.aa_b = fmt::format("sobol:{} seed 2", options.reference_samples);
    about.max_bounces = scene.max_bounces;
    about.hash_a = hash_of(a.picture);
    about.hash_b = hash_of(b.picture);
    about.halves_rmse = image_error(clamped(a.picture), clamped(b.picture)).rmse;
    about.from_cache = a.from_cache && b.from_cache;
    about.cache_path = a.path;
    converged.picture = mean_of(a.picture, b.picture);
    about.seconds = watch.seconds();
    return converged;
}

}  // namespace rt
