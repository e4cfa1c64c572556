// SPDX-License-Identifier: Apache-2.0
#include "host/cli/options.h"

#include <unistd.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <span>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/image/output_file.h"
#include "host/opencl/cl_renderer.h"
#include "host/opencl/devices.h"
#include "host/scene/words.h"

namespace rt {

namespace {

/// Whether results that begin so may take a file's place: there is none, or such a file.
bool may_hold(const std::string& path, const std::string& first_bytes) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) return true;
    std::ifstream file(path, std::ios::binary);
    std::string start(first_bytes.size(), ' ');
    file.read(start.data(), static_cast<std::streamsize>(start.size()));
    return file.gcount() == 0 || start == first_bytes;
}

glm::dvec3 parse_ambient(const std::string& text) {
    constexpr const char* expected = "expected R,G,B or one number, from 0 to 1e30, such as 0.2";
    std::vector<double> n;
    for (const std::string& part : split_list(text, expected)) {
        n.push_back(parse_number<double>(part).value_or(-1));
        if (!(n.back() >= 0 && n.back() <= max_scene_number)) refuse(text, expected);
    }
    if (n.size() != 1 && n.size() != 3) refuse(text, expected);
    return n.size() == 1 ? glm::dvec3(n[0]) : glm::dvec3(n[0], n[1], n[2]);
}

}  // namespace

void refuse(const std::string& value, const std::string& reason) { throw BadValue{value, reason}; }

void refuse_choice(const std::string& value, const std::vector<std::string>& choices) {
    const std::vector<std::string> first(choices.begin(), choices.end() - 1);
    refuse(value,
           fmt::format("expected {}{}{}{}", fmt::join(first, ", "), first.empty() ? "" : " or ",
                       choices.back(), guess_text(value, choices)));
}

PictureSize parse_size(const std::string& text) {
    const auto numbers = parse_integers(text, 'x');
    if (!numbers || numbers->size() > 2) {
        refuse(text, "expected WIDTHxHEIGHT or N, in pixels, such as 640x480 or 500");
    }
    const PictureSize size{numbers->front(), numbers->back()};
    if (size.width < 1 || size.height < 1) refuse(text, "each side must be at least 1 pixel");
    if (size.width > max_image_side || size.height > max_image_side ||
        std::int64_t{size.width} * size.height > max_image_pixels) {
        throw BadValue{text,
                       fmt::format("too large; at most {} pixels per side and {} in total",
                                   max_image_side, max_image_pixels),
                       ExitCode::limit};
    }
    return size;
}

AaMode parse_aa(const std::string& text) {
    const auto mode = parse_aa_mode(text);
    if (!mode) refuse(text, std::string("expected ") + aa_mode_help);
    return *mode;
}

std::string parse_device(const std::string& text) {
    if (text.empty()) refuse(text, "expected a device, or auto");
    parse_device_specs(text);
    return text;
}

std::vector<std::string> split_list(const std::string& text, const std::string& reason) {
    const std::vector<std::string> parts = split(text, ',');
    if (std::ranges::count(parts, "") > 0) refuse(text, reason);
    return parts;
}

std::optional<std::vector<int>> parse_integers(std::string_view text, char separator) {
    std::vector<int> numbers;
    for (const std::string& part : split(text, separator)) {
        const char* const end = part.data() + part.size();
        int number = 0;
        const auto [stop, error] = std::from_chars(part.data(), end, number);
        if (error == std::errc::result_out_of_range) {
            number = std::numeric_limits<int>::max();
        } else if (error != std::errc{}) {
            return std::nullopt;
        }
        if (stop != end) return std::nullopt;
        numbers.push_back(number);
    }
    return numbers;
}

std::string device_from_environment() {
    const std::string platform = environment("CL_PLATFORM_INDEX"),
                      device = environment("CL_DEVICE_INDEX"),
                      name = environment("CL_PLATFORM_NAME"),
                      type = lower(environment("CL_DEVICE_TYPE"));
    const std::string place =
        (platform.empty() ? "0" : platform) + ":" + (device.empty() ? "0" : device);
    const std::array<std::string, 2> variables[] = {
        {"MIRRORBALL_DEVICE", environment("MIRRORBALL_DEVICE")},
        {"CL_PLATFORM_INDEX and CL_DEVICE_INDEX", (platform + device).empty() ? "" : place},
        {"CL_PLATFORM_NAME", name.empty() ? "" : "name:" + name},
        {"CL_DEVICE_TYPE", type == "default" ? "" : type}};
    for (const auto& [variable, spec] : variables) {
        if (spec.empty()) continue;
        try {
            parse_device_specs(spec);
            return spec;
        } catch (const Error& error) {
            throw Error(error.exit_code(), "in $" + variable + ": " + error.what());
        }
    }
    return "";
}

void add_size(Verb& verb, std::optional<PictureSize>& size) {
    verb.value("--size", "WxH|N", size, parse_size,
               "picture size in pixels (default: the scene's)");
}

void add_encoding(Verb& verb, Encoding& encoding) {
    add_choice(verb, "--encoding", encoding, encoding_names,
               "how 8-bit files store linear light (default: display, value x 255)");
}

void add_device_list(Verb& verb, const std::string& option, std::vector<std::string>& devices) {
    verb.value(option, "LIST", devices, list_of(parse_device),
               "devices as for render --device, separated by commas (default: all, which is "
               "pthreads and every OpenCL device)");
}

void add_precisions(Verb& verb, std::vector<Precision>& precisions) {
    static const Named<std::vector<Precision>> choices[] = {
        {"float", {Precision::float32}},
        {"double", {Precision::float64}},
        {"both", {Precision::float32, Precision::float64}}};
    add_choice(verb, "--precision", precisions, choices, "arithmetic precision (default: both)");
}

void add_repeats(Verb& verb, int& repeats, int least) {
    verb.value(
        "--repeats", "N", repeats, count_in(least, 1000),
        fmt::format("number of timed rounds after the warm-up, at least {} (default: 5)", least));
}

void check_result_path(const std::string& path, const std::string& first_bytes) {
    if (path.empty() || path == "-") return;
    check_output_path(path);
    if (may_hold(path, first_bytes)) return;
    throw Error(ExitCode::usage,
                path + ": already exists and is not such a result file; choose another name");
}

void ResultFiles::add(Verb& verb, const std::string& option, const std::string& first_bytes,
                      const std::string& help) {
    File& file = files_[option];
    file.first_bytes = first_bytes;
    const auto accepts = [first_bytes](const std::string& word) {
        return word == "-" || (!word.starts_with('-') && may_hold(word, first_bytes));
    };
    verb.optional_value(option, "FILE|-", help, "-", accepts, [&file](const std::string& text) {
        if (text.empty()) refuse(text, "expected a file name, or - for stdout");
        file.path = text;
    });
}

void ResultFiles::check(const std::vector<std::string>& inputs,
                        std::vector<std::string> outputs) const {
    std::string user;
    for (const auto& [option, file] : files_) {
        outputs.push_back(file.path);
        if (file.path != "-") continue;
        if (!user.empty()) {
            usage_error("{} and {} cannot both write to stdout; send one to a file", user, option);
        }
        user = option;
    }
    check_outputs(outputs, UsedFiles(inputs));
    for (const auto& [option, file] : files_) check_result_path(file.path, file.first_bytes);
}

bool ResultFiles::take_stdout() const {
    return std::ranges::any_of(files_, [](const auto& file) { return file.second.path == "-"; });
}

void ResultFiles::write(const std::string& option, const std::function<std::string()>& text) const {
    const std::string& path = files_.at(option).path;
    if (path.empty()) return;
    const std::string result = text();
    if (path == "-") return print_result(result);
    write_file_atomically(path, std::as_bytes(std::span(result)));
}

void add_build_extras(Verb& verb) {
    verb.option("--cl-options", "TEXT", "further options for the compilers of OpenCL drivers",
                [](const std::string& text) { build_extras().options = text; });
    verb.value("--save-kernels", "FOLDER", build_extras().folder,
               "save source, options, log and binary of every program that a driver builds");
}

void add_light_options(Verb& verb, LightOverrides& light) {
    verb.value("--light-scale", "X", light.light_scale,
               number_in(0.0, max_scene_number, "a number from 0 to 1e30, such as 0.5"),
               "intensity of lights that have none (default: NFF sqrt(n)/2n, JSON 1, models "
               "0.75 and 0.25)");
    verb.value("--ambient", "R,G,B|X", light.ambient_light, parse_ambient,
               "ambient light (default: the scene's)");
}

void add_picture_output(Verb& verb, std::string& output, std::optional<PictureFormat>& format,
                        const std::string& help) {
    const auto parse_output = [](const std::string& text) {
        if (text.empty()) refuse(text, "expected the name of a picture file");
        return text;
    };
    const auto parse_format = [](const std::string& text) {
        const auto known = known_picture_format("picture." + text);
        if (known && lower(text) != "pgm") return known;
        refuse(text, "expected png, exr, pfm, tif, jpg, webp, hdr, tga, bmp, ppm or dpx");
    };
    verb.value("-o,--output", "FILE|-", output, parse_output, help);
    verb.value("--format", "png|exr|pfm|..", format, parse_format,
               "picture format of standard output, -o - (default: png)");
}

void settle_picture_output(const std::string& output, std::optional<PictureFormat>& format) {
    if (output != stdout_path) {
        if (format) usage_error("--format requires -o -; a file's extension sets its format");
        return;
    }
    if (!format) format = PictureFormat::png;
    if (isatty(STDOUT_FILENO) == 1) {
        usage_error("-o - would write a picture to the terminal; redirect it to a file or a pipe");
    }
}

}  // namespace rt
