// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/base/text.h"
#include "host/print/flatten_text.h"
#include "host/print/print_stats.h"

namespace rt {

namespace {

std::string device_text(const DeviceStats& device) {
    if (device.lanes == 0) return device.name;  // several devices
    if (!device.schedule.empty()) {
        return fmt::format("{}, {}, {} ({})", counted(device.threads, "thread"), device.schedule,
                           counted(device.lanes, "lane"), device.isa);
    }
    return fmt::format("{}, per {}, {}", device.name, device.launch, counted(device.lanes, "lane"));
}

std::string share_text(const DeviceShare& share) {
    const std::string pixels = counted(static_cast<std::size_t>(share.pixels), "pixel");
    if (!share.failure.empty()) {
        return fmt::format("{}: {} before it failed: {}", share.name, pixels, share.failure);
    }
    if (share.ready == 0) return share.name + ": was not ready in time";
    return fmt::format("{}: {}, ready after {:.3f} s", share.name, pixels, share.ready);
}

Features without(Features features, const Features& others) {
    for (const FeatureName& name : feature_names) {
        if (others.*name.flag) features.*name.flag = false;
    }
    return features;
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
        "{:.2f} "
        "Mrays/s\n",
        "primary", stats.rays.primary, "shadow", stats.rays.shadow, "mirror", stats.rays.mirror,
        "transmitted", stats.rays.transmitted, "total", stats.rays.total(),
        stats.rays_per_second() * 1e-6);
}

}  // namespace

std::string names_text(const Features& features, bool used) {
    const auto names = names_of(features, used);
    return names.empty() ? "nothing" : fmt::format("{}", fmt::join(names, ", "));
}

std::string holdings_text(const RenderStats& stats) {
    return fmt::format(
        "{}, {}, {}, {}{}{}", counted(stats.scene.spheres, "sphere"),
        counted(stats.scene.cones, "cone"), counted(stats.scene.triangles, "triangle"),
        counted(stats.scene.lights, "light"), stats.features.mirrors ? ", mirrors" : "",
        stats.features.glass ? ", glass" : "");
}

std::string summary_line(const RenderStats& stats) {
    return fmt::format(
        "{}: {}x{} {} {} on {}: {:.2f} Mrays in {:.3f} s ({:.1f} Mrays/s), total "
        "{:.3f} s, image {}",
        stats.scene.name, stats.region.width, stats.region.height, to_string(stats.aa),
        precision_name(stats.double_precision), device_text(stats.device),
        static_cast<double>(stats.rays.total()) * 1e-6, stats.phases.renderer.trace,
        stats.rays_per_second() * 1e-6, stats.phases.total, hash_text(stats.image_hash));
}

std::string error_line(const ImageError& error) {
    return fmt::format(
        "RMSE {:.3e}, mean {:.3e}, max {:.3e} at {},{}, PSNR {:.1f} dB, {} "
        "over 1/255, {} over 8/255, {} not finite",
        error.rmse, error.mean, error.max, error.max_x, error.max_y, error.psnr,
        counted(error.over_1, "pixel"), error.over_8, error.non_finite);
}

std::string driver_time_text(const RenderStats& stats) {
    return fmt::format(
        "kernels ran for only {:.3f} s of the {:.3f} s of tracing, probably because the driver was "
        "compiling; run again to see the true speed",
        stats.phases.renderer.kernel, stats.phases.renderer.trace);
}

std::string stats_text(const RenderStats& stats) {
    std::string text = fmt::format(
        "scene   {} ({}; hash {})\n"
        "picture {}x{}, {}, {} bounces, {}, {} math, image hash {}\n"
        "device  {}\n",
        stats.scene.name, holdings_text(stats), hash_text(stats.scene.hash), stats.region.width,
        stats.region.height, to_string(stats.aa), stats.max_bounces,
        precision_name(stats.double_precision), math_name(stats.fast_math),
        hash_text(stats.image_hash), device_text(stats.device));
    if (!stats.device.fallback_from.empty()) {
        text += fmt::format("        instead of {}, which failed\n", stats.device.fallback_from);
    }
    if (stats.shares.size() > 1) {
        for (const DeviceShare& share : stats.shares) text += "        " + share_text(share) + "\n";
    }
    if (stats.resumed > 0) {
        text +=
            fmt::format("        {:.0f} % of the first pass from a journal\n", 100 * stats.resumed);
    }
    if (stats.tiles_checked > 0) {
        text += fmt::format("        {} traced again on threads: identical\n",
                            counted(stats.tiles_checked, "tile"));
    }
    const Features compiled = either_of(stats.features, stats.device.kernels);
    text += fmt::format("needs   {}\n", names_text(stats.features, true));
    if (!(compiled == stats.features)) {
        text += fmt::format("also has {}\n", names_text(without(compiled, stats.features), true));
    }
    text += fmt::format("leaves out {}\n", names_text(compiled, false));
    text += fmt::format("builds  {}\ncasters {}\n", hierarchies_text(stats.scene.flatten),
                        casters_text(stats.scene.flatten));
    text += phases_text(stats.phases) + rays_text(stats);
    if (stats.driver_took_its_time()) text += "note    " + driver_time_text(stats) + "\n";
    if (stats.error) text += "error   " + error_line(*stats.error) + "\n";
    return text;
}

}  // namespace rt
