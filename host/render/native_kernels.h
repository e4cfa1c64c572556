// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/flatten/features.h"
#include "host/flatten/flat_scene.h"
#include "host/render/picture_spec.h"

// The kernels as machine code, compiled ahead of time (cmake/native_kernels.cmake): what pthreads
// run.
namespace rt {

/// A scene as the kernels see it; SceneView of kernels/scene_view.h. The flat scene must outlive
/// it.
template <typename T>
struct NativeView {
#define RT_NATIVE_FIELD(type, name, what) const typename Flat<T>::type* name;
    RT_SCENE_ARRAYS(RT_NATIVE_FIELD)
#undef RT_NATIVE_FIELD
    typename Flat<T>::LaunchParams params;
};

template <typename T>
NativeView<T> native_view(const FlatScene<T>& scene);

/// One build of the kernels. The functions run work items first to end - 1; kernels/items.cl says
/// what an item is, kernels/native/native.cl what the arguments are.
template <typename T>
struct NativeKernels {
    using Index = typename Flat<T>::Index;
    using Tile = typename Flat<T>::Tile;
    using Counts = typename Flat<T>::RayCounts;
    using View = NativeView<T>;

    const char* isa;  ///< the instruction set, such as x86-64-v4
    int isa_lanes;    ///< values of T per vector
    Features features;
    int lanes;    ///< rays per packet
    int samples;  ///< per pixel, compiled in; 0: any number

    void (*render_pixels)(T* film, Counts*, const View*, const Tile*, Index first, Index end);
    /// The same with packets for tiles of one pixel.
    void (*render_pixel)(T* film, Counts*, const View*, const Tile*, Index first, Index end);
    void (*render_samples)(T* samples, Counts*, const View*, const Tile*, Index first, Index end);
    void (*resolve_samples)(T* film, const T* samples, const typename Flat<T>::LaunchParams*,
                            const Tile*, Index first, Index end);
    /// Null where a number of samples is compiled in.
    void (*render_centers)(T* planes, Counts*, const View*, const Tile*, Index first, Index end);
    void (*render_round)(T* film, Counts*, const View*, const Tile*, T* planes, Index round,
                         Index first, Index end);
    /// Null unless all features are compiled in.
    void (*trace_rays)(typename Flat<T>::RayAnswer*, const typename Flat<T>::RayQuery*, const View*,
                       Index count, Index first, Index end);
};

/// The instruction sets that have kernels and that this processor supports, best first.
std::vector<std::string> native_isas();

/// Whether fma is one instruction there; otherwise it is a call, with the same result.
bool has_fast_fma(const std::string& isa);

/// The leanest kernels that satisfy the choice and render `samples` per pixel (0: any number).
/// Throws Error (ExitCode::device) if this processor cannot run the instruction set.
template <typename T>
const NativeKernels<T>& choose_native(const KernelChoice& choice, int samples);

}  // namespace rt
