// SPDX-License-Identifier: Apache-2.0
#include "host/options/picture_output.h"

#include <unistd.h>

#include "host/base/error.h"
#include "host/image/output_path.h"
#include "host/options/parse.h"

namespace rt {

void add_picture_output(const CommandLine& verb, std::string& output,
                        std::optional<PictureFormat>& format, const std::string& help) {
    const auto parse_output = [](const std::string& text) {
        if (text.empty()) refuse(text, "expected the name of a picture file");
        return text;
    };
    const auto parse_format = [](const std::string& text) {
        const auto known = known_picture_format("picture." + text);
        if (!known) refuse(text, "expected png, exr, pfm, tif, jpg, webp, hdr, tga, bmp or ppm");
        return known;
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
