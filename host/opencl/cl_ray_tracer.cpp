// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>

#include "host/opencl/cl_renderer.h"
#include "host/opencl/opencl.h"

namespace rt {

namespace {

/// Rays per launch: few enough items that PoCL does not compile the kernel again.
constexpr std::size_t rays_of_a_launch = 1 << 15;

template <typename T>
class ClRayTracer {
   public:
    ClRayTracer(const FlatScene<T>& scene, const ClDevice& device, const ClOptions& options)
        : device_(device),
          programs_(options.open_devices),
          context_(programs_->context(device)),
          queue_(context_, handle_of(device)),
          scene_(upload_scene(scene, context_, queue_, device)) {
        ProgramOptions program;
        program.precision = precision_of<T>;
        program.lanes = packet_lanes<T>(options.kernels.lanes, device);
        program.math = options.math;
        program.more = options.kernels.cl_options;
        program.entries = {false, false, true};
        lanes_ = static_cast<std::size_t>(program.lanes);
        kernel_ = cl::Kernel(programs_->program(device, render_kernels, program), "trace_rays");
        const cl_uint params = set_arguments(kernel_, 2, scene_);
        kernel_.setArg(params, scene.params);
        count_argument_ = params + 1;
        queries_ = make_cl_buffer(context_, device_, rays_of_a_launch * sizeof(Query), "the rays",
                                  CL_MEM_READ_ONLY);
        answers_ = make_cl_buffer(context_, device_, rays_of_a_launch * sizeof(Answer),
                                  "what the rays hit", CL_MEM_WRITE_ONLY);
        kernel_.setArg(0, answers_);
        kernel_.setArg(1, queries_);
    }

    void trace(std::span<const typename Flat<T>::RayQuery> queries,
               std::span<typename Flat<T>::RayAnswer> answers) {
        for (std::size_t at = 0; at < queries.size(); at += rays_of_a_launch) {
            const std::size_t count = std::min(queries.size() - at, rays_of_a_launch);
            trace_some(&queries[at], &answers[at], count);
        }
    }

   private:
    using Query = typename Flat<T>::RayQuery;
    using Answer = typename Flat<T>::RayAnswer;

    void trace_some(const Query* queries, Answer* answers, std::size_t count) {
        const std::size_t group = fitting_group(kernel_, device_, 16);
        const std::size_t items = (count + lanes_ - 1) / lanes_;
        const std::size_t whole_groups = (items + group - 1) / group * group;
        kernel_.setArg(count_argument_, static_cast<typename Flat<T>::Index>(count));
        queue_.enqueueWriteBuffer(queries_, CL_TRUE, 0, count * sizeof(Query), queries);
        queue_.enqueueNDRangeKernel(kernel_, cl::NullRange, whole_groups, group);
        queue_.enqueueReadBuffer(answers_, CL_TRUE, 0, count * sizeof(Answer), answers);
    }

    const ClDevice device_;
    const std::shared_ptr<OpenDevices> programs_;
    cl::Context context_;
    cl::CommandQueue queue_;
    std::vector<cl::Buffer> scene_;
    cl::Kernel kernel_;
    cl::Buffer queries_, answers_;
    cl_uint count_argument_ = 0;
    std::size_t lanes_ = 1;
};

}  // namespace

template <typename T>
RayTracer<T> make_cl_ray_tracer(const FlatScene<T>& scene, const ClDevice& device,
                                const ClOptions& options) {
    try {
        const auto tracer = std::make_shared<ClRayTracer<T>>(scene, device, options);
        return [tracer, device](auto queries, auto answers) {
            try {
                tracer->trace(queries, answers);
            } catch (const cl::Error& error) {
                throw_device_error(device, error);
            }
        };
    } catch (const cl::Error& error) {
        throw_device_error(device, error);
    }
}

template RayTracer<float> make_cl_ray_tracer(const FlatScene<float>&, const ClDevice&,
                                             const ClOptions&);
template RayTracer<double> make_cl_ray_tracer(const FlatScene<double>&, const ClDevice&,
                                              const ClOptions&);

}  // namespace rt
