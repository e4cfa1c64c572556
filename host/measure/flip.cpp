// SPDX-License-Identifier: Apache-2.0
#include "host/measure/flip.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <memory>
#include <string_view>
#include <system_error>
#include <vector>

#include "host/error.h"

namespace rt {

namespace {

/// Reads two pictures of float RGB from stdin, the reference first, and ends with one line on
/// stdout: "flip MEAN VERSION" or "missing MODULE". Imports no modules from the current folder.
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

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
/// An unnamed open file, which vanishes when it is closed or the process ends.
using NamelessFile = std::unique_ptr<std::FILE, CloseFile>;

[[noreturn]] void fail(const char* what, int error) {
    throw std::system_error(error, std::generic_category(), what);
}

NamelessFile nameless_file() {
    NamelessFile file(std::tmpfile());
    if (!file) fail("FLIP: cannot make a temporary file", errno);
    return file;
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
    if (std::fwrite(rgb.data(), sizeof(float), rgb.size(), file) != rgb.size()) {
        fail("FLIP: cannot write a temporary file", errno);
    }
}

std::string contents(std::FILE* file) {
    std::rewind(file);
    std::string text;
    char buffer[4096];
    while (const std::size_t size = std::fread(buffer, 1, sizeof(buffer), file)) {
        text.append(buffer, size);
    }
    return text;
}

/// How python3 is started: its streams are our files, and SIGPIPE and SIGXFSZ kill it again.
class SpawnSettings {
   public:
    SpawnSettings(std::FILE* in, std::FILE* out) {
        posix_spawn_file_actions_init(&actions_);
        posix_spawn_file_actions_adddup2(&actions_, fileno(in), STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&actions_, fileno(out), STDOUT_FILENO);
        posix_spawn_file_actions_adddup2(&actions_, fileno(out), STDERR_FILENO);
        posix_spawnattr_init(&attributes_);
        sigset_t signals;
        sigemptyset(&signals);
        sigaddset(&signals, SIGPIPE);
        sigaddset(&signals, SIGXFSZ);
        posix_spawnattr_setsigdefault(&attributes_, &signals);
        posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGDEF);
    }
    ~SpawnSettings() {
        posix_spawn_file_actions_destroy(&actions_);
        posix_spawnattr_destroy(&attributes_);
    }
    SpawnSettings(const SpawnSettings&) = delete;
    SpawnSettings& operator=(const SpawnSettings&) = delete;

    const posix_spawn_file_actions_t* actions() const { return &actions_; }
    const posix_spawnattr_t* attributes() const { return &attributes_; }

   private:
    posix_spawn_file_actions_t actions_;
    posix_spawnattr_t attributes_;
};

/// Runs python3 until it exits; returns the error number if it cannot be started, else 0.
int run_python(std::vector<std::string> arguments, std::FILE* in, std::FILE* out) {
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const SpawnSettings settings(in, out);
    pid_t child = 0;
    const int error = posix_spawnp(&child, "python3", settings.actions(), settings.attributes(),
                                   argv.data(), environ);
    if (error != 0) return error;
    int status = 0;
    while (waitpid(child, &status, 0) == -1 && errno == EINTR) {
    }
    return 0;
}

/// The last line of a text, without its newline.
std::string_view last_line(std::string_view text) {
    while (text.ends_with('\n')) text.remove_suffix(1);
    return text.substr(text.rfind('\n') + 1);
}

FlipResult result_of(const std::string& output) {
    const std::string_view line = last_line(output);
    if (line.starts_with("missing ")) {
        return {{},
                fmt::format("the python3 of PATH has no module {}; install it with 'python3 -m "
                            "pip install flip-evaluator numpy'",
                            line.substr(8))};
    }
    double mean = 0;
    if (line.starts_with("flip ")) {
        const char* const end = line.data() + line.size();
        const auto [stop, error] = std::from_chars(line.data() + 5, end, mean);
        if (error == std::errc{} && stop != end) {
            return {mean, fmt::format("flip-evaluator {}, 67 pixels per degree",
                                      std::string_view(stop + 1, end))};
        }
    }
    return {{}, fmt::format("flip-evaluator failed: {}", line.empty() ? "no output" : line)};
}

}  // namespace

FlipResult measure_flip(const Picture& picture, const Picture& reference) {
    const NamelessFile in = nameless_file(), out = nameless_file();
    write_pixels(in.get(), reference);
    write_pixels(in.get(), picture);
    if (std::fflush(in.get()) != 0) fail("FLIP: cannot write a temporary file", errno);
    std::rewind(in.get());
    const int error = run_python(
        {"python3", "-c", program, std::to_string(picture.width), std::to_string(picture.height)},
        in.get(), out.get());
    if (error != 0) {
        return {{},
                fmt::format("no python3 in PATH ({}); install it, and 'python3 -m pip install "
                            "flip-evaluator numpy'",
                            std::generic_category().message(error))};
    }
    return result_of(contents(out.get()));
}

}  // namespace rt
