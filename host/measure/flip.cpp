// SPDX-License-Identifier: Apache-2.0
#include "host/measure/flip.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>
#include <utility>
#include <vector>

namespace rt {

namespace {

/// Reads two pictures of float RGB from stdin, the reference first, and ends with one line on
/// stdout: "flip MEAN VERSION" or "missing MODULE". Imports no modules from the current folder.
/// Holds no single quote: the shell sees it between two.
constexpr const char* program = R"(
import sys
sys.path = [p for p in sys.path if p]
try:
    import flip_evaluator
    import numpy
except ImportError as error:
    print("\nmissing", error.name or error)
    sys.exit()
import importlib.metadata
width, height = int(sys.argv[1]), int(sys.argv[2])
values = numpy.frombuffer(sys.stdin.buffer.read(), numpy.float32)
reference, test = values.reshape(2, height, width, 3).copy()
mean = flip_evaluator.evaluate(reference, test, "LDR", applyMagma=False)[1]
print("\nflip", repr(float(mean)), importlib.metadata.version("flip-evaluator"))
)";

[[noreturn]] void fail(const char* what) {
    throw std::system_error(errno, std::generic_category(), what);
}

void write_pixels(std::FILE* file, const Picture& picture) {
    const auto channels = static_cast<std::size_t>(picture.channels);
    const bool gray = channels < 3;
    std::vector<float> rgb;
    rgb.reserve(picture.pixels.size() / channels * 3);
    for (std::size_t i = 0; i < picture.pixels.size(); i += channels) {
        for (std::size_t c = 0; c < 3; ++c) {
            rgb.push_back(std::clamp(picture.pixels[gray ? i : i + c], 0.0f, 1.0f));
        }
    }
    if (std::fwrite(rgb.data(), sizeof(float), rgb.size(), file) != rgb.size() ||
        std::fflush(file) != 0) {
        fail("FLIP: cannot write a temporary file");
    }
}

/// What a shell command prints, and its status. The shell is given no text from outside.
std::pair<std::string, int> run(const std::string& command) {
    std::FILE* const pipe = ::popen(command.c_str(), "r");
    if (pipe == nullptr) fail("FLIP: cannot start a shell");
    std::string text;
    char buffer[4096];
    while (const std::size_t size = std::fread(buffer, 1, sizeof buffer, pipe)) {
        text.append(buffer, size);
    }
    return {text, ::pclose(pipe)};
}

FlipResult result_of(std::string output) {
    while (output.ends_with('\n')) output.pop_back();
    const std::string line = output.substr(output.rfind('\n') + 1);
    if (line.starts_with("missing ")) {
        return {{},
                fmt::format("python3 has no module {}; install it with 'python3 -m "
                            "pip install flip-evaluator numpy'",
                            line.substr(8))};
    }
    double mean = 0;
    char version[32];
    if (std::sscanf(line.c_str(), "flip %lf %31s", &mean, version) == 2) {
        return {mean, fmt::format("flip-evaluator {}, 67 pixels per degree", version)};
    }
    return {{}, "flip-evaluator failed: " + (line.empty() ? "no output" : line)};
}

}  // namespace

FlipResult measure_flip(const Picture& picture, const Picture& reference) {
    // Nameless: it vanishes when it is closed or the process ends.
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), std::fclose);
    if (!file) fail("FLIP: cannot make a temporary file");
    write_pixels(file.get(), reference);
    write_pixels(file.get(), picture);
    const auto [output, status] =
        run(fmt::format("exec python3 -c '{}' {} {} </proc/self/fd/{} 2>&1", program, picture.width,
                        picture.height, fileno(file.get())));
    constexpr int not_found = 127;
    if (WIFEXITED(status) && WEXITSTATUS(status) == not_found) {
        return {{},
                "no python3 in PATH; install it, then run 'python3 -m pip install flip-evaluator "
                "numpy'"};
    }
    return result_of(output);
}

}  // namespace rt
