// SPDX-License-Identifier: Apache-2.0
#include "host/verbs/batch_log.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>

#include <charconv>
#include <sstream>

namespace rt {

FileDescriptor BatchLog::make_memory() { return FileDescriptor(memfd_create("batch", 0)); }

BatchLog::BatchLog(const std::string& descriptor) {
    const auto end = descriptor.data() + descriptor.size();
    if (std::from_chars(descriptor.data(), end, memory_).ptr != end) memory_ = -1;
    std::string text;
    char chunk[4096];
    for (ssize_t got; (got = pread(memory_, chunk, sizeof chunk, std::ssize(text))) > 0;) {
        text.append(chunk, static_cast<std::size_t>(got));
    }
    std::istringstream records(text);
    for (std::string record; std::getline(records, record);) {
        if (record.starts_with('l')) {
            bytes_of_lines_ += record.size();  // the newline instead of the 'l'
            lines_.push_back(record.substr(1));
            continue;
        }
        std::istringstream fields(record.substr(1));
        std::size_t picture = 0;
        int status = 0;
        if (fields >> picture >> status) statuses_.emplace(picture, status);
    }
}

std::optional<std::string> BatchLog::next_line() {
    if (lines_.empty()) return std::nullopt;
    std::string line = std::move(lines_.front());
    lines_.pop_front();
    return line;
}

std::optional<int> BatchLog::status_of(std::size_t picture) const {
    const auto found = statuses_.find(picture);
    return found == statuses_.end() ? std::nullopt : std::optional(found->second);
}

void BatchLog::add_finished(std::size_t picture, int status) {
    append(fmt::format("f{} {}", picture, status));
}

/// In one call, so that a process that crashes leaves whole records.
void BatchLog::append(const std::string& record) const {
    if (memory_ < 0) return;
    const std::string line = record + "\n";
    [[maybe_unused]] const auto written = write(memory_, line.data(), line.size());
}

}  // namespace rt
