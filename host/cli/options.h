// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/text.h"
#include "host/cli/command_line.h"
#include "host/image/encoding.h"
#include "host/image/picture_io.h"
#include "host/picture/render_settings.h"
#include "host/scene/scene_file.h"

// Parsing of option values, and the options that several verbs share.
namespace rt {

/// Rejects the value of the option being read, or a part of it: throws BadValue.
[[noreturn]] void refuse(const std::string& value, const std::string& reason);

/// The same for a text that is none of the choices; guesses which one was meant.
[[noreturn]] void refuse_choice(const std::string& value, const std::vector<std::string>& choices);

// Readers of an option's value, or makers of such readers; all reject other text.

/// WIDTHxHEIGHT or N; ExitCode::limit for too many pixels.
PictureSize parse_size(const std::string& text);

AaMode parse_aa(const std::string& text);

inline std::string parse_text(const std::string& text) { return text; }

/// A device spec, or several separated by commas: the text, once checked. Throws Error.
std::string parse_device(const std::string& text);

/// A number from `least` to `most`; `expected` says so.
template <typename N>
auto number_in(N least, N most, const std::string& expected) {
    return [=](const std::string& text) {
        const auto number = parse_number<N>(text);
        if (!number || !(*number >= least && *number <= most)) refuse(text, "expected " + expected);
        return *number;
    };
}

/// A whole number from `least` to `most`.
inline auto count_in(int least, int most) {
    return number_in(least, most, fmt::format("a whole number from {} to {}", least, most));
}

/// Seconds from `least` to 1e8.
inline auto seconds_from(double least) {
    return number_in(least, 1e8, fmt::format("a number of seconds from {:g} to 1e8", least));
}

/// "5%" or "5": 0.05.
inline auto percent_to(double most) {
    return [most](const std::string& text) {
        const bool has_sign = text.ends_with('%');
        const auto percent = parse_number<double>(text.substr(0, text.size() - (has_sign ? 1 : 0)));
        if (!percent || !(*percent >= 0 && *percent <= most)) {
            refuse(text, fmt::format("expected a percentage from 0% to {:g}%", most));
        }
        return *percent / 100;
    };
}

/// The parts between commas; rejects an empty part, for this reason.
std::vector<std::string> split_list(
    const std::string& text, const std::string& reason = "expected a list separated by commas");

/// A list separated by commas, each part read by `parse`.
template <typename Parse>
auto list_of(Parse parse) {
    return [parse](const std::string& text) {
        std::vector<std::decay_t<decltype(parse(text))>> values;
        for (const std::string& part : split_list(text)) values.push_back(parse(part));
        return values;
    };
}

/// The same without duplicates.
template <typename Parse>
auto set_of(Parse parse) {
    return [parse](const std::string& text) {
        decltype(list_of(parse)(text)) values;
        for (const auto& value : list_of(parse)(text)) {
            if (std::ranges::count(values, value) == 0) values.push_back(value);
        }
        return values;
    };
}

/// Integers with a separator between them; those too large for int become its largest value, for
/// range checks to reject. Empty for any other text.
std::optional<std::vector<int>> parse_integers(std::string_view text, char separator);

/// The device where --device is not given: MIRRORBALL_DEVICE, or what test suites of drivers set:
/// CL_PLATFORM_INDEX with CL_DEVICE_INDEX, CL_PLATFORM_NAME, CL_DEVICE_TYPE; "" without any. Throws
/// Error (ExitCode::usage) for what --device would refuse.
std::string device_from_environment();

template <typename T, std::size_t n>
std::vector<std::string> names_of(const Named<T> (&choices)[n]) {
    std::vector<std::string> names;
    for (const Named<T>& choice : choices) names.emplace_back(choice.name);
    return names;
}

/// A name from a table, which must outlive the reader.
template <typename T, std::size_t n>
auto one_of(const Named<T> (&choices)[n]) {
    return [&choices](const std::string& text) {
        const std::optional<T> value = value_of(choices, text);
        if (!value) refuse_choice(text, names_of(choices));
        return *value;
    };
}

/// An option that takes a name from a table.
template <typename T, typename N, std::size_t n>
void add_choice(Verb& verb, const std::string& option, T& target, const Named<N> (&choices)[n],
                const std::string& help) {
    verb.value(option, fmt::format("{}", fmt::join(names_of(choices), "|")), target,
               one_of(choices), help);
}

/// Comma-separated AA modes, without duplicates.
inline std::vector<AaMode> parse_aa_list(const std::string& text) { return set_of(parse_aa)(text); }

// Options that several verbs share.
/// --light-scale and --ambient, for every verb that reads scenes.
void add_light_options(Verb& verb, LightOverrides& light);

void add_size(Verb& verb, std::optional<PictureSize>& size);
void add_encoding(Verb& verb, Encoding& encoding);
void add_device_list(Verb& verb, const std::string& option, std::vector<std::string>& devices);
void add_precisions(Verb& verb, std::vector<Precision>& precisions);
void add_repeats(Verb& verb, int& repeats, int least);

/// Rejects, before anything is measured, a path that could not or should not be written: Error
/// (output) for a place that cannot be written, Error (usage) for an existing file that does not
/// begin with `first_bytes` as results do: "--json scene.json" must not replace a scene. Accepts ""
/// and "-".
void check_result_path(const std::string& path, const std::string& first_bytes);

/// Where a verb's results go in addition to its table: for each option a file, or stdout.
class ResultFiles {
   public:
    /// Adds --json, --csv or --junit: alone, the results go to stdout ("-"). The next word is the
    /// file unless that exists and is not such a result file: a scene or a picture. The verb refers
    /// to this object.
    void add(Verb& verb, const std::string& option, const std::string& first_bytes,
             const std::string& help);

    /// Rejects, before anything is measured, what check_result_path rejects, several results on
    /// stdout, and files that are one of the inputs or one of the other outputs.
    void check(const std::vector<std::string>& inputs, std::vector<std::string> outputs) const;

    bool take_stdout() const;

    /// Writes the text to stdout or atomically to a file; if the option is not given, it does not
    /// ask for it. Throws Error (output).
    void write(const std::string& option, const std::function<std::string()>& text) const;

   private:
    struct File {
        std::string path;  ///< "-": stdout; empty: none
        std::string first_bytes;
    };
    std::map<std::string, File> files_;  ///< by option
};

/// --cl-options and --save-kernels, for every verb that builds kernels.
void add_build_extras(Verb& verb);

inline constexpr const char* bounces_help =
    "maximum number of mirror and refracted rays after the eye ray (default: the scene's)";
inline constexpr const char* quiet_help = "print no progress to stderr";
inline constexpr const char* scene_help = "scene file (.json, .nff, .obj, .ply)";
inline constexpr const char* json_help = "print JSON to stdout";

/// Adds -o, with the given help, and --format, the format of "-".
void add_picture_output(Verb& verb, std::string& output, std::optional<PictureFormat>& format,
                        const std::string& help);

/// Sets the format of standard output. Throws Error (ExitCode::usage) if it is a terminal, and if
/// --format is given for a file, whose extension sets its format.
void settle_picture_output(const std::string& output, std::optional<PictureFormat>& format);

}  // namespace rt
