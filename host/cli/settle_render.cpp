// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "host/base/error.h"
#include "host/base/text.h"
#include "host/cli/options.h"
#include "host/cli/render_options.h"
#include "host/image/output_file.h"
#include "host/image/picture_io.h"
#include "host/scene/scene_file.h"
#include "host/scene/text_file.h"

namespace rt {

namespace {

constexpr std::size_t most_bytes = std::size_t{1} << 28;  ///< of a list

/// The places of a frame's number; [1] is the least number of digits, if it is given.
std::vector<std::smatch> frame_numbers(const std::string& name) {
    static const std::regex number("%0*([1-9]?)d(?![[:alnum:]])");
    return {std::sregex_iterator(name.begin(), name.end(), number), std::sregex_iterator()};
}

std::string frame_output(const std::string& pattern, int frame) {
    const std::vector<std::smatch> numbers = frame_numbers(pattern);
    if (numbers.size() != 1) return pattern;
    const std::smatch& number = numbers.front();
    return fmt::format("{}{:0{}}{}", number.prefix().str(), frame,
                       parse_number<int>(number[1].str()).value_or(1), number.suffix().str());
}

/// The next name of a line; empty at its end.
std::optional<std::string> next_name(std::istringstream& words, const std::string& where) {
    if ((words >> std::ws).eof()) return std::nullopt;
    std::string name;
    if (!(words >> std::quoted(name))) {
        usage_error("{}missing closing quote; put names with spaces in double quotes", where);
    }
    if (name.empty()) usage_error("{}empty name; expected SCENE or SCENE OUTPUT", where);
    return name;
}

void add_line(const std::string& line, const std::string& where, std::vector<BatchItem>& items) {
    std::istringstream words(line);
    const std::optional<std::string> scene = next_name(words, where);
    if (!scene || scene->starts_with("#")) return;
    const std::string output = next_name(words, where).value_or("");
    if (const auto more = next_name(words, where)) {
        usage_error(
            "{}unexpected '{}' after SCENE and OUTPUT; put names with spaces in double quotes",
            where, *more);
    }
    items.push_back({where, *scene, output, {}});
}

void add_list(const std::string& path, std::vector<BatchItem>& items) {
    const bool is_stdin = path == "-";
    const FileText list = is_stdin ? read_stdin() : read_text_file(path, most_bytes);
    std::string_view text = list.view();
    if (text.starts_with(utf8_byte_order_mark)) {  // some editors begin files so
        text.remove_prefix(utf8_byte_order_mark.size());
    }
    std::istringstream lines{std::string(text)};
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        const std::string where = fmt::format("{}:{}: ", is_stdin ? "stdin" : path, ++number);
        add_line(line, where, items);
        if (is_stdin && !items.empty() && items.back().scene == stdin_scene) {
            usage_error("{}standard input is already the list of scenes; name a scene file", where);
        }
    }
}

/// Whether the name of an output has one "%d" or "%04d", to be replaced by a frame's number, unless
/// a letter or digit follows.
bool has_frame_number(const std::string& name) { return frame_numbers(name).size() == 1; }

/// The pattern with each %s, unless a letter or digit follows, replaced by the name of the
/// scene's file, without folder and extension.
std::string batch_output(const std::string& pattern, const std::string& scene) {
    static const std::regex name("%s(?![[:alnum:]])"), dollar("[$]");
    const std::string text = std::filesystem::path(scene).stem().string();
    return std::regex_replace(pattern, name, std::regex_replace(text, dollar, "$$$$"));
}

/// The pictures: the frames, or the scenes of the command line and then those of the list, a line
/// each: "SCENE" or "SCENE OUTPUT", with names with blanks in double quotes; empty lines and those
/// that begin with '#' are none. Throws Error: ExitCode::input for a list that cannot be read,
/// ExitCode::usage for a wrong line, and if two pictures would share a file.
std::vector<BatchItem> batch_items(const RenderOptions& options) {
    std::vector<BatchItem> items;
    for (const int frame : options.frames) {
        items.push_back({fmt::format("frame {}: ", frame), options.scenes.front(),
                         frame_output(options.output, frame), frame});
    }
    if (!items.empty()) return items;
    for (const std::string& scene : options.scenes) items.push_back({"", scene, "", {}});
    if (!options.batch.empty()) add_list(options.batch, items);
    if (items.empty()) usage_error("the list contains no scenes");
    std::vector<std::string> outputs;
    for (BatchItem& item : items) {
        if (item.output.empty()) item.output = batch_output(options.output, item.scene);
        outputs.push_back(item.output);
    }
    check_outputs(outputs);
    return items;
}

/// Options that cannot be combined, and what to say then.
struct Conflict {
    bool is_there;
    const char* message;
};

void refuse_conflicts(const std::vector<Conflict>& conflicts) {
    for (const Conflict& conflict : conflicts) {
        if (conflict.is_there) usage_error("{}", conflict.message);
    }
}

/// What a target starts with. The error of edges:T is about T.
AaMode first_aa(double target_rmse, Filter filter) {
    if (filter == Filter::box) {
        const double tolerance = std::clamp(target_rmse, AaMode::min_tolerance, 1.0);
        return {AaMode::Pattern::edges, 1, tolerance};
    }
    return {AaMode::Pattern::sobol, std::max(fewest_samples(filter), 4), 0};
}

bool compares(const RenderOptions& render) {
    return !render.reference.empty() || render.expected_hash;
}

/// Rejects two uses of the same standard stream.
void settle_streams(RenderOptions& render) {
    settle_picture_output(render.output, render.format);
    const bool prints = render.stats != StatsFormat::summary || !render.reference.empty();
    const bool reads_scene = std::ranges::count(render.scenes, stdin_scene) > 0;
    refuse_conflicts(
        {{render.output == stdout_path && prints,
          "-o - cannot be combined with --stats or --reference, which print to stdout"},
         {render.batch == "-" && reads_scene,
          "standard input cannot be both a scene and a list of scenes"}});
}

/// Frames of one scene; with shares, every nth frame.
void settle_frames(RenderOptions& render) {
    refuse_conflicts(
        {{render.scenes.size() != 1 || !render.batch.empty(),
          "--frames requires exactly one scene"},
         {compares(render), "--reference and --expect cannot be combined with --frames"}});
    render.scene = render.scenes.front();
    render.output = batch_output(render.output, render.scene);
    const bool is_pattern =
        render.frames.size() > 1 || render.output.find('%') != std::string::npos;
    if (!render.output.empty() && is_pattern && !has_frame_number(render.output)) {
        usage_error("-o '{}': with --frames, use %04d for the frame number, as in out.%04d.png",
                    render.output);
    }
    if (!render.shares) return;
    std::vector<int> own;
    for (std::size_t i = 0; i < render.frames.size(); ++i) {
        const int share = static_cast<int>(i % static_cast<std::size_t>(render.shares->of));
        if (std::ranges::count(render.shares->numbers, share) > 0) own.push_back(render.frames[i]);
    }
    if (own.empty()) usage_error("--shard leaves no frames to render; use fewer shares");
    render.frames = std::move(own);
    render.shares.reset();
}

/// One scene, or a batch.
void settle_scenes(RenderOptions& render) {
    if (!render.frames.empty()) return settle_frames(render);
    if (!render.is_batch()) {
        if (render.scenes.empty()) {
            usage_error("SCENE is required; see 'mirrorball render --help'");
        }
        render.scene = render.scenes.front();
        if (has_frame_number(render.output)) {
            usage_error("-o '{}' contains a frame number; add --frames or change the name",
                        render.output);
        }
        render.output = batch_output(render.output, render.scene);
        return;
    }
    if (compares(render)) usage_error("--reference and --expect work only for a single scene");
    if (!render.output.empty() && render.output.find("%s") == std::string::npos) {
        usage_error(
            "-o '{}': with several scenes, use %s for the scene file's name, as in out/%s.png",
            render.output);
    }
}

}  // namespace

void settle_render(RenderOptions& render) {
    settle_streams(render);
    settle_scenes(render);
    const bool has_shares = render.shares.has_value(), is_batch = render.is_batch();
    const bool has_target = render.target_rmse > 0, is_fast = render.math == Math::fast;
    if (render.resume) render.journal_delay = 0;
    if (has_target && !render.aa) render.aa = first_aa(render.target_rmse, render.filter);
    refuse_conflicts(
        {{render.fresh && render.resume, "--fresh cannot be combined with --resume"},
         {has_shares && is_batch, "--shard works only for a single scene"},
         {has_shares && compares(render),
          "--reference and --expect cannot be combined with --shard"},
         {has_shares && (is_fast || render.schedule != Schedule::tiles),
          "--shard requires --math strict and --schedule tiles, so that its parts match"},
         {has_shares && !render.output.ends_with(".mbj"), "--shard requires -o FILE.mbj"},
         // A target starts with a few samples; its journal would be of another picture each time.
         {has_target && (has_shares || render.resume),
          "--target-rmse cannot be combined with --shard or --resume"},
         {render.resume && (render.output == stdout_path || (render.output.empty() && !is_batch)),
          "--resume requires -o FILE, next to which it saves finished tiles"},
         {has_target && render.aa->refines(),
          "--target-rmse requires --aa edges:T, sobol:N, grid:N or none"},
         {render.estimate && has_shares,
          "--estimate works only for a whole picture, without --shard"},
         // Threads have no fast math, so every tile would differ.
         {render.check > 0 && is_fast, "--check requires --math strict"},
         {render.watch && (is_batch || render.scene == stdin_scene || has_shares),
          "--watch works only for a single scene file, without --shard"},
         {render.watch && (render.output == stdout_path || render.timeout > 0),
          "--watch cannot be combined with -o - or --timeout"},
         {!render.aovs.empty() && (is_batch || has_shares),
          "--aov works only for a single, whole picture"},
         {!render.aovs.empty() && (render.output.empty() || render.output == stdout_path),
          "--aov requires -o FILE, from which it derives its file names"}});
    if (!is_batch) {
        render.items.push_back({"", render.scene, render.output, {}});
        return;
    }
    render.items = batch_items(render);
    if (!render.output.empty()) {
        check_picture_path(batch_output(render.output, "scene"), render.format);
    }
}

}  // namespace rt
