// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "host/scene/line_scanner.h"
#include "host/scene/model.h"

namespace rt {

/// Reads a Wavefront OBJ (1992): v, vn and f make the mesh; docs/scene-format.md lists the other
/// statements. `open` opens material libraries; without it materials are ignored. Faces that cannot
/// be built are left out with a note; throws Error, ExitCode::input, if none is left.
Model parse_obj(std::string_view text, const std::string& file_name, const OpenLibrary& open,
                const ReadPace& pace = {});

}  // namespace rt
