// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "host/cli/verb_texts.h"

namespace rt {

namespace {

/// Text, escaped for roff.
std::string roff(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '\\') {
            escaped += "\\e";
        } else if (c == '-') {
            escaped += "\\-";
        } else if (c == ',') {
            escaped += ",\\:";  // lists may break here
        } else {
            escaped += c;
        }
    }
    return escaped.starts_with('.') || escaped.starts_with('\'') ? "\\&" + escaped : escaped;
}

std::string option_roff(const OptionText& option) {
    std::string text = ".TP\n";
    for (std::size_t i = 0; i < option.names.size(); ++i) {
        text += fmt::format("{}\\f{}{}\\fR", i == 0 ? "" : ", ", option.is_word ? 'I' : 'B',
                            roff(option.is_word ? option.word() : option.names[i]));
    }
    if (!option.type.empty()) text += " \\fI" + roff(option.type) + "\\fR";
    return text + "\n" + roff(option.help) + "\n";
}

std::string synopsis(const std::string& name, const VerbText& verb) {
    std::string text = fmt::format(".B {}\n", roff(name));
    text += "[\\fIoptions\\fR]";
    for (const OptionText& option : verb.options) {
        if (!option.is_word) continue;
        const std::string word = "\\fI" + roff(option.word()) + "\\fR";
        text += option.is_required ? " " + word : " [" + word + "]";
    }
    return text + "\n.br\n";
}

std::string synopses(const std::string& name, const VerbText& verb) {
    if (verb.verbs.empty()) return synopsis(name, verb);
    std::string text;
    for (const VerbText& one : verb.verbs) text += synopses(name + " " + one.name, one);
    return text;
}

std::string sections(const std::string& name, const VerbText& verb) {
    std::string text;
    if (!verb.options.empty()) {
        text += fmt::format(".SS {}\n{}\n", roff(name), roff(verb.help));
        for (const OptionText& option : verb.options) text += option_roff(option);
    }
    for (const VerbText& one : verb.verbs) text += sections(name + " " + one.name, one);
    return text;
}

constexpr const char* description = R"(.SH DESCRIPTION
Traces scenes of spheres, cones, triangles and meshes, with Phong lighting, mirrors and glass, on
OpenCL devices or on threads: the same bits on each. It measures error against run time, compares
pictures, and tests devices and numerical stability.
)";

constexpr const char* examples = R"(.SH EXAMPLES
.TP
.B mirrorball render scene.json \-o picture.png
renders a scene on the best device
.TP
.B mirrorball bench \-\-devices pocl,threads
compares a device with threads
.TP
.B mirrorball converge scene.json
measures error against run time
.TP
.B mirrorball doctor
tests each OpenCL driver
)";

constexpr const char* see_also = R"(.SH SEE ALSO
.BR clinfo (1),
.BR oclgrind (1),
.BR povray (1)
)";

constexpr const char* exit_statuses = R"(.SH EXIT STATUS
.TP
0
success
.TP
1
a comparison or check found a difference
.TP
2
usage error
.TP
3
input rejected
.TP
4
output not written
.TP
5
no usable device, or it failed under \-\-no\-fallback
.TP
6
non\-finite pixels
.TP
7
over a memory or size limit
.TP
8
incomplete: parts of the picture are missing, \-\-timeout ran out, or \-\-target\-rmse was not reached
.TP
70
a bug in mirrorball
.TP
129, 130, 138, 143, 152
stopped by a signal; the picture so far is saved next to the output
)";

constexpr const char* file_section = R"(.SH FILES
.I PREFIX
is
.I /usr
for the Debian package, else what was given to
.BR "cmake \-\-install \-\-prefix" .
.TP
.I PREFIX/share/mirrorball/scenes
scenes to start from, such as
.I cornell\-box.json
.TP
.I PREFIX/share/mirrorball/schemas
JSON schemas of results
.TP
.I PREFIX/share/doc/mirrorball
a tutorial, and descriptions of scenes, results and numerics
)";

}  // namespace

std::string man_page(const VerbText& program, const std::string& version) {
    std::string text =
        fmt::format(".TH MIRRORBALL 1 \"\" \"{}\" \"User Commands\"\n", roff(version));
    text += ".ad l\n";
    text += fmt::format(".SH NAME\n{} \\- {}\n", roff(program.name), roff(program.help));
    text += ".SH SYNOPSIS\n" + synopses(program.name, program);
    text += description;
    text += ".SH OPTIONS\n" + sections(program.name, program);
    return text + exit_statuses +
           ".SH ENVIRONMENT\n.TP\n.B MIRRORBALL_DEVICE\nthe default of "
           "\\fB\\-\\-device\\fR in \\fBrender\\fR\n.TP\n.B CL_PLATFORM_INDEX, CL_DEVICE_INDEX, "
           "CL_PLATFORM_NAME, CL_DEVICE_TYPE\nthe same, as test suites of drivers set them\n" +
           file_section + examples + see_also;
}

}  // namespace rt
