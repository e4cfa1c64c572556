// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rt {

/// What the threads of the pthreads renderer take from each other.
enum class Schedule {
    tiles,    ///< threads take tiles from a shared counter
    buffers,  ///< the paper's: a thread renders whole sample buffers, averaged at the end
};

}  // namespace rt
