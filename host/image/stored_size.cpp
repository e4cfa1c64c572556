// SPDX-License-Identifier: Apache-2.0
#include "host/image/stored_size.h"

#include <iterator>

namespace rt {

void check_stored_values(const std::string& path, PictureFormat format, std::uintmax_t values,
                         std::uintmax_t file_size) {
    const std::uintmax_t most = values_per_byte(format);
    if (most != 0) check_stored_size(path, values, most, file_size);
}

void check_jpeg_end(const std::string& path, InputFile& file) {
    const std::string bytes{std::istreambuf_iterator<char>(file.stream), {}};
    const std::size_t scan = bytes.rfind("\xff\xda");  // the last one; thumbnails come before
    if (scan != bytes.npos && bytes.find("\xff\xd9", scan) != bytes.npos) return;
    refuse_picture(path, "has no end-of-image marker", "it may be truncated: save it again");
}

}  // namespace rt
