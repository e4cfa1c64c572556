// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace rt {

/// The functions of an OpenCL C text, as far as finding out who calls whom needs it. What macros
/// mention counts as called: they paste names together.
class SourceParts {
   public:
    explicit SourceParts(const std::string& source);

    /// Where in the text the function is defined: the number of parts before it.
    std::size_t place_of(const std::string& function) const;

    /// The text without comments and without the functions that the kernel does not reach.
    std::string reduced_to(const std::string& kernel) const;

   private:
    struct Part {
        std::string name;  ///< of a function; empty: always kept, with all it mentions
        std::string text;
        std::vector<std::string> words;
    };

    std::vector<Part> parts_;
};

/// A kernel launch as contrib/reproduce/reproduce.c makes it.
struct KernelLaunch {
    struct Argument {
        std::string kind;  ///< value, in, out or scratch
        std::vector<std::byte> bytes;
    };
    std::string kernel, options, numbers = "float";
    std::size_t items = 1, group = 64;
    std::vector<Argument> arguments;

    std::size_t whole_groups() const { return (items + group - 1) / group * group; }

    void add(const char* kind, std::span<const std::byte> bytes) {
        arguments.push_back({kind, {bytes.begin(), bytes.end()}});
    }
    template <typename T>
    void add_value(const T& x) {
        add("value", std::as_bytes(std::span(&x, 1)));
    }
};

/// Writes reproduce.c, kernel.cl, launch.txt, the arguments and README to a folder. Throws Error
/// (output).
void write_reproducer(const std::string& folder, const KernelLaunch& launch,
                      const std::string& source, const std::string& readme);

}  // namespace rt
