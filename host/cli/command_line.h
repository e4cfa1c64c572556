// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/base/error.h"

namespace rt {

/// Why the value of an option, or a part of it, is refused. CommandLine adds the option's name.
struct BadValue {
    std::string value, reason;
    ExitCode exit_code = ExitCode::usage;
};

using TakeText = std::function<void(const std::string&)>;
using AcceptsText = std::function<bool(const std::string&)>;

struct CommandLineParser;

/// The program's command line, or one verb of it, under construction; a copyable handle. Hides
/// CLI11, whose header takes ten seconds to compile: only command_line.cpp includes it.
class CommandLine {
   public:
    CommandLine verb(const std::string& name, const std::string& help) const;

    /// An option that takes a value; `take` throws BadValue to reject it.
    void option(const std::string& name, const std::string& type, const std::string& help,
                const TakeText& take, bool required = false) const;

    /// An option whose value `parse` turns into the target's.
    template <typename T, typename Parse>
    void value(const std::string& name, const std::string& type, T& target, const Parse& parse,
               const std::string& help, bool required = false) const {
        const auto take = [&target, parse](const std::string& text) { target = parse(text); };
        option(name, type, help, take, required);
    }

    /// An option whose value is a name: any text but an empty one, as from a script's unset
    /// variable.
    void value(const std::string& name, const std::string& type, std::string& target,
               const std::string& help) const;

    /// An option that may stand alone and then means `bare`. The next word is its value if
    /// `accepts` returns true for it; in `--name=VALUE` it always is.
    void optional_value(const std::string& name, const std::string& type, const std::string& help,
                        const std::string& bare, const AcceptsText& accepts,
                        const TakeText& take) const;

    /// The heading in --help of the options that are added next.
    void group(const std::string& name) const;

    void flag(const std::string& names, bool& value, const std::string& help) const;

    /// A positional argument.
    void argument(const std::string& name, std::string& value, const std::string& help) const;
    void arguments(const std::string& name, std::vector<std::string>& values,
                   const std::string& help, bool required) const;

    /// Called after this verb's whole command line has been read.
    void when_chosen(const std::function<void()>& action) const;

    bool given(const std::string& option) const;

   private:
    friend struct CommandLineParser;
    CommandLine(CommandLineParser& parser, void* app) : parser_(&parser), app_(app) {}

    CommandLineParser* parser_;
    void* app_;  ///< CLI::App
};

struct CommandLineTexts {
    std::string program, about, version;
};

/// Lets `describe` add the verbs, then reads the command line. Returns the help or version text to
/// print if it was requested, else "". Throws Error (ExitCode::usage).
std::string read_command_line(const CommandLineTexts& texts,
                              const std::function<void(const CommandLine&)>& describe, int argc,
                              const char* const* argv);

}  // namespace rt
