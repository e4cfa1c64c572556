// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "host/flatten/flat_scene.h"
#include "host/render/renderer.h"

namespace rt {

enum class Schedule {
    tiles,    ///< threads take tiles from a shared counter
    buffers,  ///< the paper's: a thread renders whole sample buffers, averaged at the end
};

struct ThreadsOptions {
    int threads = 0;  ///< 0: all cores, or one a sample buffer with Schedule::buffers
    Schedule schedule = Schedule::tiles;
};

/// Threads that will run for these options and sampling.
int thread_count(const ThreadsOptions& options, int samples);

/// The baseline: plain scalar C++ on POSIX threads. The scene must outlive the renderer.
template <typename T>
std::unique_ptr<Renderer<T>> make_threads_renderer(const FlatScene<T>& scene,
                                                   const ThreadsOptions& options);

}  // namespace rt
