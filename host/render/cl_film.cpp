// SPDX-License-Identifier: Apache-2.0
#include "host/render/cl_film.h"

#include "host/render/cl_buffer.h"

namespace rt {

template <typename T>
ClFilm<T>::ClFilm(Film<T>& film, const cl::Context& context, const cl::CommandQueue& queue,
                  const ClDevice& device)
    : film_(film), queue_(queue), is_shared_(device.is_cpu) {
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
void ClFilm<T>::read_back() {
    if (is_shared_) {
        void* const mapped = queue_.enqueueMapBuffer(buffer_, CL_TRUE, CL_MAP_READ, 0, bytes());
        queue_.enqueueUnmapMemObject(buffer_, mapped);
        queue_.finish();
    } else {
        queue_.enqueueReadBuffer(buffer_, CL_TRUE, 0, bytes(), film_.rgb.data());
    }
}

template class ClFilm<float>;
template class ClFilm<double>;

}  // namespace rt
