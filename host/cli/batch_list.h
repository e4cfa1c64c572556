// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "host/base/files.h"
#include "host/cli/render_options.h"

namespace rt {

/// Whether the name of an output has one "%d" or "%04d", to be replaced by a frame's number, unless
/// a letter or digit follows.
bool has_frame_number(const std::string& name);

/// The pattern with each %s, unless a letter or digit follows, replaced by the scene's name,
/// without folder and extension.
std::string batch_output(const std::string& pattern, const std::string& scene);

/// A picture of a batch.
struct BatchItem {
    std::size_t number = 0;  ///< from 1
    std::string where;       ///< "list.txt:3: ", for messages; empty: the command line
    std::string scene;
    std::string output;  ///< empty: none
    std::optional<int> frame;
};

/// "SCENE" or "SCENE OUTPUT"; names with blanks go in double quotes. Empty for an empty line or one
/// that begins with '#'. Throws Error (ExitCode::usage).
std::optional<BatchItem> parse_batch_line(const std::string& line);

/// The scenes named by a list; none if it is not a regular file, since it may have no end.
std::vector<std::string> scenes_of_list(const std::string& path);

/// The pattern with its %d or %04d replaced by the frame number.
std::string frame_output(const std::string& pattern, int frame);

/// What a worker had read and finished of a batch before its driver failed. It tells its parent
/// each line of a list that can be read only once, and how each picture went.
class BatchPast {
   public:
    explicit BatchPast(const std::vector<std::string>& records);

    static void tell_line(const std::string& line);
    static void tell_finished(std::size_t picture, int status);

    std::optional<int> status_of(std::size_t picture) const;
    std::deque<std::string> take_lines() { return std::move(lines_); }

   private:
    std::deque<std::string> lines_;
    std::map<std::size_t, int> statuses_;
};

/// Reads lines as they arrive. A stop signal ends the wait for one.
class LineReader {
   public:
    /// "-": stdin. `past`: lines that were read before. Throws Error (ExitCode::input) when the
    /// file cannot be opened.
    LineReader(const std::string& path, std::deque<std::string> past);

    /// Empty at the end of the file and after a stop signal.
    std::optional<std::string> next();

   private:
    bool read_more();

    std::deque<std::string> past_;
    FileDescriptor file_;
    std::size_t chunk_ = 1;  ///< bytes to read at once: of a pipe, none of the next line
    std::string text_;       ///< read, but not yet returned
    bool at_end_ = false;
};

/// The frames, or the scenes of the command line and then those of the list, read as it arrives.
class BatchList {
   public:
    /// Throws Error (ExitCode::input) when the list cannot be opened.
    BatchList(const RenderOptions& options, BatchPast& past);

    /// Gets the next item; false if there is none. Throws Error for an invalid line, and
    /// ExitCode::usage if two scenes would share an output file; the next call continues after it.
    bool next(BatchItem& item);

   private:
    bool take(BatchItem& item);

    const RenderOptions& options_;
    std::size_t number_ = 0;
    std::size_t given_ = 0;  ///< frames or command-line scenes taken so far
    std::optional<LineReader> lines_;
    int line_ = 0;
    std::set<std::string> outputs_;
};

}  // namespace rt
