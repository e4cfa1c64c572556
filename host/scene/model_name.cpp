// SPDX-License-Identifier: Apache-2.0
#include "host/scene/model_name.h"

#include <fmt/format.h>

#include "host/scene/utf8.h"

namespace rt {

std::string model_name(std::string_view bytes) {
    const bool plain = !find_invalid_utf8(bytes);
    std::string name;
    for (const char c : bytes) {
        const bool keep = !is_control(c) && (plain || static_cast<unsigned char>(c) < 0x80);
        if (keep) {
            name += c;
        } else {
            name += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
        }
    }
    return name;
}

}  // namespace rt
