// SPDX-License-Identifier: Apache-2.0
#include "host/opencl/cl_film.h"

#include <array>

#include "host/opencl/opencl.h"

namespace rt {

template <typename T>
ClFilm<T>::ClFilm(Film<T>& film, const cl::Context& context, const cl::CommandQueue& queue,
                  const ClDevice& device, bool is_shared)
    : film_(film), queue_(queue), is_shared_(is_shared) {
    const cl_mem_flags shared = is_shared_ ? CL_MEM_USE_HOST_PTR : 0;
    buffer_ = make_cl_buffer(context, device, bytes(), "the film", CL_MEM_READ_WRITE | shared,
                             is_shared_ ? film.rgb.data() : nullptr);
    if (!is_shared_) queue_.enqueueFillBuffer(buffer_, T(0), 0, bytes());
}

template <typename T>
ClFilm<T>::~ClFilm() {
    if (is_shared_) clFinish(queue_());
}

template <typename T>
void ClFilm<T>::read_back(const Rect& rect, const cl::CommandQueue& reads) {
    const std::size_t pixel = 3 * sizeof(T), row = pixel * static_cast<std::size_t>(film_.width);
    if (is_shared_) {
        void* const mapped = reads.enqueueMapBuffer(buffer_, CL_TRUE, CL_MAP_READ,
                                                    row * static_cast<std::size_t>(rect.y),
                                                    row * static_cast<std::size_t>(rect.height));
        reads.enqueueUnmapMemObject(buffer_, mapped);
        return;
    }
    if (rect.width == film_.width) {
        const std::size_t at = 3 * static_cast<std::size_t>(rect.y * film_.width);
        reads.enqueueReadBuffer(buffer_, CL_TRUE, at * sizeof(T),
                                row * static_cast<std::size_t>(rect.height), &film_.rgb[at]);
        return;
    }
    const std::array<std::size_t, 3> corner{pixel * static_cast<std::size_t>(rect.x),
                                            static_cast<std::size_t>(rect.y), 0};
    const std::array<std::size_t, 3> size{pixel * static_cast<std::size_t>(rect.width),
                                          static_cast<std::size_t>(rect.height), 1};
    reads.enqueueReadBufferRect(buffer_, CL_TRUE, corner, corner, size, row, 0, row, 0,
                                film_.rgb.data());
}

template <typename T>
void ClFilm<T>::finish() {
    if (!is_shared_) return;
    void* const mapped = queue_.enqueueMapBuffer(buffer_, CL_TRUE, CL_MAP_READ, 0, bytes());
    queue_.enqueueUnmapMemObject(buffer_, mapped);
    queue_.finish();
}

template class ClFilm<float>;
template class ClFilm<double>;

}  // namespace rt
