// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/text.h"
#include "host/cli/batch_list.h"
#include "host/cli/render_steps.h"
#include "host/image/output_path.h"
#include "host/image/picture_io.h"
#include "host/opencl/device_spec.h"
#include "host/picture/crew_members.h"
#include "host/print/print_stats.h"
#include "host/process/stop_signal.h"
#include "host/process/worker.h"
#include "host/render/stopwatch.h"
#include "host/scene/scene.h"

namespace rt {

namespace {

/// Aborts the whole batch.
struct BatchEnds : Error {
    using Error::Error;
};

/// Whether a frame that exists is the one to be rendered, as far as its metadata tell.
bool may_show(const std::string& path, const Scene& scene, const RenderOptions& options) {
    const auto format = known_picture_format(path);
    if (format != PictureFormat::png && format != PictureFormat::exr) return true;
    try {
        const PictureMetadata found = read_picture_header(path).metadata;
        return text_in(found, "mirrorball:SceneHash").empty() ||
               shows_the_same(found, picture_metadata(scene.name, hash_text(scene_hash(scene)),
                                                      to_string(picture_spec(scene, options)), ""));
    } catch (const Error&) {
        return false;
    }
}

/// JSON of a batch: one line per picture.
void print_batch_results(const RenderStats& stats, const RenderOptions& options,
                         const std::function<void()>& note) {
    try {
        if (options.stats == StatsFormat::json) {
            const std::string line = stats_json(stats).dump() + "\n";
            note();
            print_result(line);
        } else {
            note();
            print_results(stats, options);
        }
        flush_results();
    } catch (const Error& error) {
        throw BatchEnds(error.exit_code(), error.what());
    }
}

/// Writes a picture and reports how it went. Returns the exit status. `note` gets it just before
/// the results are printed: a driver may end this process at any moment.
int finish_picture(RenderedPicture rendered, const RenderOptions& options, const Stopwatch& total,
                   const std::function<void(int status)>& note) {
    const Stopwatch writing;
    const std::string path = save_picture(rendered, options);
    rendered.stats.phases.write = writing.seconds();
    rendered.stats.phases.total = total.seconds();
    const int status = verdict(rendered, options, path);
    print_batch_results(rendered.stats, options, [&] { note(status); });
    return status;
}

/// Renders a picture while the one before it is written.
class Batch {
   public:
    explicit Batch(const RenderOptions& options)
        : options_(options), devices_(start_finding_devices(options).get()) {
        if (!options.output.empty()) {
            check_picture_path(batch_output(options.output, "scene"), options.format);
        }
        inputs_.add(options.batch);
        for (const BatchItem& item : options.items) inputs_.add(item.scene);
        for (const std::string& record : options.batch_past) {
            std::istringstream fields(record);
            std::size_t at = 0;
            int status = 0;
            fields >> at >> status;
            past_[at] = status;
        }
    }

    int run() {
        for (std::size_t at = 0; at < options_.items.size() && stop_flag() == 0; ++at) {
            if (const auto past = past_.find(at); past != past_.end()) {
                count(at, past->second);
            } else {
                attempt(at, [&] { start(at); });
            }
        }
        settle();
        return sum_up();
    }

   private:
    /// Other errors than BatchEnds are noted.
    template <typename Work>
    void attempt(std::size_t at, const Work& work) {
        try {
            work();
        } catch (const BatchEnds&) {
            throw;
        } catch (const Error& error) {
            note(at, error);
        } catch (const std::bad_alloc&) {
            note(at, Error(ExitCode::limit, out_of_memory));
        }
    }

    void start(std::size_t at) {
        const Stopwatch total;
        const BatchItem& item = options_.items[at];
        RenderOptions options = options_;
        options.scene = item.scene;
        options.output = item.output;
        if (item.frame && options.resume && std::filesystem::exists(options.output) &&
            may_show(options.output, load(item, options), options)) {
            ++there_;
            return;
        }
        check_output(options);
        if (!has_said_unsaved_) has_said_unsaved_ = say_unsaved(options);
        inputs_.check(options.output);
        choose_journal(options);
        Stopwatch watch;
        const Scene& scene = load(item, options);
        const double load_seconds = watch.lap();
        const auto live = make_live_picture(options);
        RenderConsole console(options, live.get());
        RenderedPicture rendered =
            render_picture(scene, options, devices_, console.events(), stop_flag(), &cache_);
        leave_out_failed(devices_, rendered.stats);
        if (live) live->finish(rendered.picture);
        note_failed_device(rendered.stats, options);
        rendered.stats.scene.path = options.scene;
        rendered.stats.phases.load = load_seconds;
        settle();
        written_ = at;
        writing_ = std::async(
            std::launch::async, [rendered = std::move(rendered), options, total, at]() mutable {
                return finish_picture(std::move(rendered), options, total,
                                      [at](int status) { tell_finished(at, status); });
            });
        if (live) wait_for_viewers(*live);
    }

    /// A camera path's scene is loaded once. Throws BatchEnds where no frame can be rendered.
    const Scene& load(const BatchItem& item, const RenderOptions& options) {
        if (!item.frame) {
            load_afresh(options);
            return scene_;
        }
        if (!has_path_) load_path(options);
        scene_.camera = camera_at(scene_, *item.frame);
        set_image_size(scene_, scene_.width, scene_.height);
        return scene_;
    }

    void load_afresh(const RenderOptions& options) {
        scene_ = scene_to_render(options);
        for (const std::string& file : scene_.model_files) inputs_.add(file);
    }

    void load_path(const RenderOptions& options) try {
        load_afresh(options);
        if (scene_.path.keys.empty()) camera_at(scene_, 0);  // throws
        has_path_ = true;
    } catch (const Error& error) {
        throw BatchEnds(error.exit_code(), error.what());
    }

    /// Waits for the picture that is being written.
    void settle() {
        if (!writing_.valid()) return;
        attempt(written_, [&] { count(written_, writing_.get()); });
    }

    /// A worker's parent renders what is left if the driver ends the worker.
    static void tell_finished(std::size_t at, int status) {
        tell_parent(fmt::format("{} {}", at, status));
    }

    void note(std::size_t at, const Error& error) {
        const int status = static_cast<int>(error.exit_code());
        print_note(options_.items[at].where + error.what());
        tell_finished(at, status);
        count(at, status);
    }

    void count(std::size_t at, int status) {
        ++pictures_;
        if (status == 0) return;
        const BatchItem& item = options_.items[at];
        worst_ = std::max(worst_, status);
        failed_.push_back(item.frame ? fmt::format("frame {} ({})", *item.frame, status)
                                     : fmt::format("{} ({})", item.scene, status));
    }

    int sum_up() const {
        if (there_ > 0 && !options_.quiet) {
            print_note("skipped " + counted(there_, "existing frame"));
        }
        if (stop_flag() != 0) {
            print_note(fmt::format("{} after {}", stop_reason(), counted(pictures_, "picture")));
            return exit_code_of_stop(stop_flag());
        }
        if (failed_.empty()) return 0;
        std::string text = fmt::format("{} of {} failed, with exit codes:", failed_.size(),
                                       counted(pictures_, "picture"));
        constexpr std::size_t most_named = 20;
        for (std::size_t i = 0; i < std::min(failed_.size(), most_named); ++i) {
            text += (i == 0 ? " " : ", ") + failed_[i];
        }
        print_note(text + (failed_.size() > most_named ? ", ..." : ""));
        return worst_;
    }

    const RenderOptions& options_;
    std::map<std::size_t, int> past_;  ///< the statuses of pictures that a worker has finished
    std::vector<DeviceChoice> devices_;
    RenderCache cache_;
    InputFiles inputs_;  ///< as far as they are known
    Scene scene_;
    bool has_path_ = false;  ///< scene_ is the one for all frames
    bool has_said_unsaved_ = false;
    std::size_t there_ = 0;  ///< frames skipped since their pictures existed
    std::future<int> writing_;
    std::size_t written_ = 0;
    std::size_t pictures_ = 0;
    std::vector<std::string> failed_;
    int worst_ = 0;
};

}  // namespace

int render_batch(const RenderOptions& options) {
    start_timeout(options);
    return Batch(options).run();
}

}  // namespace rt
