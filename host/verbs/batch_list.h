// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <string>

#include "host/file_descriptor.h"
#include "host/options/render_options.h"

namespace rt {

/// A picture of a batch.
struct BatchItem {
    std::string where;  ///< "list.txt:3: ", for messages; empty: the command line
    std::string scene;
    std::string output;  ///< empty: none
    std::optional<int> frame;
};

/// "SCENE" or "SCENE OUTPUT"; names with blanks stand in double quotes. Nothing for an empty line
/// and one that begins with '#'. Throws Error (ExitCode::usage).
std::optional<BatchItem> parse_batch_line(const std::string& line);

/// The pattern with the scene's name, without folder and ending, for each %s.
std::string batch_output(const std::string& pattern, const std::string& scene);

/// The pattern with the frame's number for its %d or %04d.
std::string frame_output(const std::string& pattern, int frame);

/// Lines of a file as they come. Waiting for one ends with a stop signal.
class LineReader {
   public:
    /// "-": stdin. Throws Error (ExitCode::input) when it cannot be opened.
    explicit LineReader(const std::string& path);

    /// Nothing at the end, and when a stop signal came.
    std::optional<std::string> next();

   private:
    bool read_more();

    FileDescriptor file_;
    std::string text_;  ///< read, and not yet given out
    bool at_end_ = false;
};

/// The scenes of the command line, then those of the list, which is read line by line as it comes.
class BatchList {
   public:
    /// Throws Error (ExitCode::input) when the list cannot be opened.
    explicit BatchList(const RenderOptions& options);

    /// Whether there is another one, which is then the item. Throws Error for a line that is wrong,
    /// and ExitCode::usage where two scenes would go into one file; the next call goes on after it.
    bool next(BatchItem& item);

   private:
    bool take(BatchItem& item);

    const RenderOptions& options_;
    std::size_t given_ = 0;  ///< of the command line's scenes
    std::optional<LineReader> lines_;
    int line_ = 0;
    std::set<std::string> outputs_;
};

}  // namespace rt
