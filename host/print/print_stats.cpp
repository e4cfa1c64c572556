// SPDX-License-Identifier: Apache-2.0
#include "host/print/print_stats.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>

#include "host/base/parallel.h"
#include "host/base/text.h"
#include "host/base/version.h"

namespace rt {

namespace {

std::string device_text(const DeviceStats& device) {
    if (device.lanes == 0) return device.name;  // several devices
    if (!device.schedule.empty()) {
        return fmt::format("{}, {}, {} ({})", counted(device.threads, "thread"), device.schedule,
                           counted(device.lanes, "lane"), device.isa);
    }
    return fmt::format("{}, per {}, {}", short_device_name(device.name), device.launch,
                       counted(device.lanes, "lane"));
}

std::string share_text(const DeviceShare& share) {
    const std::string pixels = counted(static_cast<std::size_t>(share.pixels), "pixel");
    const std::string name = short_device_name(share.name);
    if (!share.failure.empty()) {
        return fmt::format("{}: {} before it failed: {}", name, pixels, share.failure);
    }
    if (share.ready == 0) return name + ": was not ready in time";
    return fmt::format("{}: {}, ready after {:.3f} s", name, pixels, share.ready);
}

void add_phase(std::string& text, const char* name, double seconds, const std::string& note = "") {
    text += fmt::format("  {:<20}{:>10.4f} s{}\n", name, seconds, note.empty() ? "" : "   " + note);
}

std::string phases_text(const PhaseStats& phases) {
    const RendererTimes& renderer = phases.renderer;
    std::string text = "time\n";
    add_phase(text, "set-up", phases.set_up());
    add_phase(text, "  start", phases.start, "before main");
    add_phase(text, "  load", phases.load);
    add_phase(text, "  flatten", phases.flatten);
    if (renderer.build > 0) {
        add_phase(text, "  open device", renderer.open);
        add_phase(text, "  build kernels", renderer.build);
        add_phase(text, "  upload", renderer.upload);
        if (renderer.check > 0) add_phase(text, "  self-test", renderer.check);
    }
    add_phase(text, "ray trace", renderer.trace,
              renderer.kernel > 0 ? fmt::format("kernels {:.4f} s", renderer.kernel) : "");
    add_phase(text, "resolve and write", phases.resolve_and_write());
    if (renderer.resolve > 0) add_phase(text, "  resolve", renderer.resolve);
    if (renderer.read_back > 0) add_phase(text, "  read back", renderer.read_back);
    add_phase(text, "  write", phases.write);
    add_phase(text, "total", phases.total);
    return text;
}

std::string rays_text(const RenderStats& stats) {
    return fmt::format(
        "rays\n  {:<20}{:>12}\n  {:<20}{:>12}\n  {:<20}{:>12}\n  {:<20}{:>12}\n  {:<20}{:>12}   "
        "{:.2f} Mrays/s\n",
        "primary", stats.rays.primary, "shadow", stats.rays.shadow, "mirror", stats.rays.mirror,
        "transmitted", stats.rays.transmitted, "total", stats.rays.total(),
        stats.rays_per_second() * 1e-6);
}

std::string count_line(const char* name, std::size_t count, std::size_t pixels) {
    return fmt::format("  {:<12}{} ({:.2f} %)\n", name, counted(count, "pixel"),
                       100.0 * static_cast<double>(count) / static_cast<double>(pixels));
}

}  // namespace

std::string names_text(const Features& features, bool used) {
    const auto names = names_of(features, used);
    return names.empty() ? "nothing" : fmt::format("{}", fmt::join(names, ", "));
}

std::string kinds_text(const FlattenStats& stats) {
    std::vector<std::string> counts;
    for (const KindStats& kind : stats.kinds()) counts.push_back(counted(kind.count, kind.one));
    return fmt::format("{}", fmt::join(counts, ", "));
}

std::string holdings_text(const SceneStats& scene) {
    return fmt::format("{}, {}{}{}", kinds_text(scene.flatten), counted(scene.lights, "light"),
                       scene.features[feature::mirrors] ? ", mirrors" : "",
                       scene.features[feature::glass] ? ", glass" : "");
}

std::string flatten_text(const FlattenStats& stats) {
    std::string built;
    for (const KindStats& kind : hierarchies_of(stats)) {
        built += fmt::format("{}{} ({} nodes, {} deep)", built.empty() ? "" : ", ", kind.many,
                             kind.hierarchy.nodes, kind.hierarchy.depth);
    }
    built = built.empty() ? "none" : fmt::format("{}, built in {:.3f} s", built, stats.bvh_seconds);
    return fmt::format("BVH: {}\nshadow casters: {} of {} light-triangle pairs\n", built,
                       stats.casters, stats.lit_triangles);
}

std::string summary_line(const RenderStats& stats) {
    const std::string estimate = stats.estimate ? ", " + to_string(*stats.estimate) : "";
    return fmt::format(
        "{}: {}x{} {} {} on {}: {:.2f} Mrays in {:.3f} s ({:.1f} Mrays/s), total "
        "{:.3f} s{}, image {}",
        stats.scene.name, stats.picture.region.width, stats.picture.region.height,
        to_string(stats.picture.aa), to_string(stats.picture.precision), device_text(stats.device),
        static_cast<double>(stats.rays.total()) * 1e-6, stats.phases.renderer.trace,
        stats.rays_per_second() * 1e-6, stats.phases.total, estimate, hash_text(stats.image_hash));
}

std::string error_line(const ImageError& error) {
    return fmt::format(
        "RMSE {:.3e}, mean {:.3e}, max {:.3e} at {},{}, PSNR {:.1f} dB, {} "
        "over 1/255, {} over 8/255, {} not finite",
        error.rmse, error.mean, error.max, error.max_x, error.max_y, error.psnr,
        counted(error.over_1, "pixel"), error.over_8, error.non_finite);
}

std::string error_table(const ImageError& error, std::size_t pixels) {
    std::string text = count_line("not finite", error.non_finite, pixels);
    if (error.non_finite == pixels) return text + "  no pixel is finite in both pictures\n";
    text +=
        fmt::format("  {:<12}{:.4e}\n  {:<12}{:.4e}\n  {:<12}{:.4e} at {},{}\n  {:<12}{:.2f} dB\n",
                    "RMSE", error.rmse, "mean", error.mean, "maximum", error.max, error.max_x,
                    error.max_y, "PSNR", error.psnr);
    text += count_line("over 1/255", error.over_1, pixels);
    text += count_line("over 2/255", error.over_2, pixels);
    text += count_line("over 8/255", error.over_8, pixels);
    return text + fmt::format("  {:<12}{:.4e}\n", "relMSE", error.rel_mse);
}

std::string stats_text(const RenderStats& stats) {
    const PictureSpec& picture = stats.picture;
    std::string text = fmt::format(
        "scene   {} ({}; hash {})\n"
        "picture {}x{}, {}, {} filter, seed {}, {} bounces, {}, {} math, image hash {}\n"
        "device  {}\n",
        stats.scene.name, holdings_text(stats.scene), hash_text(stats.scene.hash),
        picture.region.width, picture.region.height, to_string(picture.aa),
        to_string(picture.filter), picture.seed, picture.max_bounces, to_string(picture.precision),
        to_string(picture.math), hash_text(stats.image_hash), device_text(stats.device));
    if (!stats.device.fallback_from.empty()) {
        text += fmt::format("        instead of {}, which failed\n", stats.device.fallback_from);
    }
    if (stats.shares.size() > 1) {
        for (const DeviceShare& share : stats.shares) text += "        " + share_text(share) + "\n";
    }
    if (stats.resumed > 0) {
        text +=
            fmt::format("        {:.0f} % of the picture from a journal\n", 100 * stats.resumed);
    }
    if (stats.tiles_checked > 0) {
        text += fmt::format("        {} traced again on threads: identical\n",
                            counted(stats.tiles_checked, "tile"));
    }
    const Features& compiled = stats.scene.compiled;
    text += fmt::format("needs: {}\nleaves out: {}\n", names_text(stats.scene.features, true),
                        names_text(compiled, false));
    if (compiled != stats.scene.features) {
        text += fmt::format("compiled in but not needed: {}\n",
                            names_text(compiled & ~stats.scene.features, true));
    }
    text += flatten_text(stats.scene.flatten);
    text += phases_text(stats.phases) + rays_text(stats);
    if (stats.estimate) {
        text += fmt::format("error   {}, estimated from {} of {} pixels in {:.3f} s\n",
                            to_string(*stats.estimate), counted(stats.estimate->samples, "sample"),
                            stats.estimate->pixels, stats.estimate->seconds);
    }
    if (stats.error) text += "error   " + error_line(*stats.error) + "\n";
    return text;
}

Json stats_json(const RenderStats& stats) {
    Json json{{"format", "mirrorball-render"}, {"version", 1}, {"environment", environment_json()}};
    json.update(json_of(stats));
    return json;
}

namespace {

#ifdef __clang__
constexpr const char* compiler = __VERSION__;  // "Debian Clang 14.0.6"
#else
constexpr const char* compiler = "GCC " __VERSION__;
#endif

constexpr const char* unknown = "unknown";

/// The text after `separator` in the first line of the file that begins with `key`.
std::string value_in(const char* path, const std::string& key, const std::string& separator) {
    std::ifstream file(path);
    std::string line;
    while (std::getline(file, line)) {
        const auto at = line.find(separator);
        if (line.rfind(key, 0) == 0 && at != std::string::npos) {
            return line.substr(at + separator.size());
        }
    }
    return unknown;
}

std::string os_name() {
    std::string name = value_in("/etc/os-release", "PRETTY_NAME", "=");
    std::erase(name, '"');
    return name;
}

std::string kernel_name() {
    utsname system{};
    uname(&system);
    return std::string(system.sysname) + " " + system.release + " " + system.machine;
}

/// The one-minute load average, in hundredths as the system reports it; null where it does not.
Json load_json() {
    double load = 0;
    return getloadavg(&load, 1) == 1 ? Json(std::round(load * 100) / 100) : Json(nullptr);
}

}  // namespace

std::string cpu_name() {
    const auto value = [](const char* key) { return value_in("/proc/cpuinfo", key, ": "); };
    const std::string family = value("cpu family"), model = value("model\t");
    std::string name = value("model name");
    if (family != unknown && model != unknown) {
        name += " (family " + family + ", model " + model + ")";
    }
    return name;
}

Json environment_json() {
    return {{"program", std::string("mirrorball ") + version},
            {"git_revision", git_revision},
            {"compiler", compiler},
            {"cpu", cpu_name()},
            {"cores", available_cores()},
            {"memory_bytes", std::int64_t{sysconf(_SC_PHYS_PAGES)} * sysconf(_SC_PAGESIZE)},
            {"os", os_name()},
            {"kernel", kernel_name()},
            {"load", load_json()}};
}

}  // namespace rt
