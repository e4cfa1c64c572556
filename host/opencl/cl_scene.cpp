// SPDX-License-Identifier: Apache-2.0
#include "host/opencl/cl_scene.h"

#include <utility>

#include "host/opencl/opencl.h"

namespace rt {

template <typename T>
ClScene<T>::ClScene(const FlatScene<T>& scene, const cl::Context& context,
                    const cl::CommandQueue& queue, const ClDevice& device) {
    const auto upload = [&](const auto& items, const char* what) {
        const std::size_t bytes = items.size() * sizeof(items[0]);
        cl::Buffer buffer = make_cl_buffer(context, device, bytes, what, CL_MEM_READ_ONLY);
        if (bytes > 0) queue.enqueueWriteBuffer(buffer, CL_TRUE, 0, bytes, items.data());
        lists_.push_back(std::move(buffer));
    };
#define RT_UPLOAD(type, name, what) upload(scene.name, what);
    RT_SCENE_ARRAYS(RT_UPLOAD)
#undef RT_UPLOAD
}

template <typename T>
cl_uint ClScene<T>::set_arguments(cl::Kernel& kernel, cl_uint first) const {
    for (const cl::Buffer& list : lists_) kernel.setArg(first++, list);
    return first;
}

template class ClScene<float>;
template class ClScene<double>;

}  // namespace rt
