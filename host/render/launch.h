// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rt {

/// What a work item of an OpenCL device is.
enum class Launch {
    automatic,  ///< pixel on CPUs, sample elsewhere
    pixel,      ///< a pixel
    sample,     ///< a sample; a second kernel averages them
};

}  // namespace rt
