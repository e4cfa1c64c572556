// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "host/flatten/flat_scene.h"
#include "host/render/native_kernels.h"
#include "host/render/renderer.h"

namespace rt {

struct ThreadsOptions {
    int threads = 0;  ///< 0: all cores, or one per sample buffer with Schedule::buffers
    Schedule schedule = Schedule::tiles;
    KernelChoice kernels = {};
};

/// Threads that will run for these options and sampling.
int thread_count(const ThreadsOptions& options, int samples);

/// The kernels that make_threads_renderer runs for these options.
template <typename T>
const NativeKernels<T>& native_kernels_for(const FlatScene<T>& scene,
                                           const ThreadsOptions& options);

/// The kernels on POSIX threads, compiled ahead of time; one ray at a time with lanes = 1. The
/// scene must outlive the renderer. Throws like choose_native.
template <typename T>
std::unique_ptr<Renderer<T>> make_threads_renderer(const FlatScene<T>& scene,
                                                   const ThreadsOptions& options);

/// Single rays on all threads.
template <typename T>
RayTracer<T> make_threads_ray_tracer(const FlatScene<T>& scene, const ThreadsOptions& options);

}  // namespace rt
