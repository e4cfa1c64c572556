// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/opencl/cl_device.h"
#include "host/opencl/opencl.h"
#include "host/render/film.h"

namespace rt {

/// A black film on a device: the film's own memory on a CPU that renders alone (if the driver
/// supports that), else a copy that is read back rectangle by rectangle. The film must outlive it.
/// Throws Error (ExitCode::limit) if it exceeds the device's largest allocation.
template <typename T>
class ClFilm {
   public:
    ClFilm(Film<T>& film, const cl::Context& context, const cl::CommandQueue& queue,
           const ClDevice& device, bool is_shared);
    /// Waits: commands in flight write to the film's memory.
    ~ClFilm();
    ClFilm(const ClFilm&) = delete;
    ClFilm& operator=(const ClFilm&) = delete;

    const cl::Buffer& buffer() const { return buffer_; }

    /// Copies a rectangle of the film, finished on the device, back; waits for nothing else.
    void read_back(const Rect& rect, const cl::CommandQueue& reads);

    /// Brings back a film in shared memory.
    void finish();

   private:
    std::size_t bytes() const { return film_.rgb.size() * sizeof(T); }

    Film<T>& film_;
    const cl::CommandQueue& queue_;
    const bool is_shared_;
    cl::Buffer buffer_;
};

}  // namespace rt
