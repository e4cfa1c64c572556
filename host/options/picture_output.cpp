// SPDX-License-Identifier: Apache-2.0
#include "host/options/picture_output.h"

#include <unistd.h>

#include "host/error.h"
#include "host/image/output_path.h"
#include "host/options/parse.h"

namespace rt {

void add_picture_output(const CommandLine& verb, std::string& output,
                        std::optional<PictureFormat>& format, const std::string& help) {
    verb.option("-o,--output", "FILE|-", help, [&output](const std::string& text) {
        if (text.empty()) refuse("-o", text, "name a picture file");
        output = text;
    });
    verb.option("--format", "png|exr|pfm|..",
                "picture format of -o -, standard output (default png)",
                [&format](const std::string& text) {
                    format = known_picture_format("picture." + text);
                    if (!format) {
                        refuse("--format", text,
                               "give png, exr or pfm (or tif, jpg, webp, hdr, tga, bmp, ppm)");
                    }
                });
}

void add_encoding(const CommandLine& verb, Encoding& encoding) {
    add_choice<Encoding>(
        verb, "--encoding", encoding,
        {{"display", Encoding::display}, {"srgb", Encoding::srgb}, {"linear", Encoding::linear}},
        "how 8-bit files store linear light (default display: value x 255)");
}

void settle_picture_output(const std::string& output, std::optional<PictureFormat>& format) {
    if (output != stdout_path) {
        if (!format) return;
        throw Error(ExitCode::usage, "--format is for -o -; the ending of a file is its format");
    }
    if (!format) format = PictureFormat::png;
    if (isatty(STDOUT_FILENO) == 1) {
        throw Error(ExitCode::usage,
                    "-o - writes a picture to standard output, which is a terminal here; send it "
                    "to a program or a file");
    }
}

}  // namespace rt
