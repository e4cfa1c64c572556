// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "host/image/encoding.h"
#include "host/view/view_settings.h"
#include "host/view/viewer.h"

namespace rt {

/// Creates the viewers of a picture called `name`. `say` receives why one cannot be created, and
/// later errors, these on another thread.
std::vector<std::unique_ptr<Viewer>> make_viewers(const ViewSettings& settings,
                                                  const std::string& name, Encoding encoding,
                                                  std::function<void(const std::string&)> say);

}  // namespace rt
