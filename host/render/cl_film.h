// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/render/cl_device.h"
#include "host/render/film.h"

namespace rt {

/// A black film on a device: on a CPU its own memory (where the driver takes that), elsewhere a
/// copy. The film must outlive it. Throws Error (ExitCode::limit) when the device gives less in one
/// piece.
template <typename T>
class ClFilm {
   public:
    ClFilm(Film<T>& film, const cl::Context& context, const cl::CommandQueue& queue,
           const ClDevice& device);
    /// Waits: commands in flight write to the film's memory.
    ~ClFilm();
    ClFilm(const ClFilm&) = delete;
    ClFilm& operator=(const ClFilm&) = delete;

    const cl::Buffer& buffer() const { return buffer_; }

    /// Brings what was rendered back into the film.
    void read_back();

   private:
    std::size_t bytes() const { return film_.rgb.size() * sizeof(T); }

    Film<T>& film_;
    const cl::CommandQueue& queue_;
    const bool is_shared_;
    cl::Buffer buffer_;
};

}  // namespace rt
