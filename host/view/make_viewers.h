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

/// The viewers of a picture called `name`. `say` hears why one cannot be, and what goes wrong with
/// one later, then on another thread.
std::vector<std::unique_ptr<Viewer>> make_viewers(const ViewSettings& settings,
                                                  const std::string& name, Encoding encoding,
                                                  std::function<void(const std::string&)> say);

}  // namespace rt
