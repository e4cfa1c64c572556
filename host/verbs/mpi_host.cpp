// SPDX-License-Identifier: Apache-2.0
#include "host/verbs/mpi_host.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "host/base/console.h"
#include "host/base/text.h"
#include "host/journal/share_queue.h"
#include "host/process/stop_signal.h"
#include "host/render/stopwatch.h"
#include "host/verbs/share_renderer.h"
#include "host/verbs/verbs.h"

namespace rt {

namespace {

using Kind = RankMessage::Kind;
using Turn = ShareQueue::Turn;

constexpr int shares_of_a_rank = 8;  ///< so that ranks finish at about the same time

class MpiHost {
   public:
    MpiHost(const RenderOptions& options, Ranks& ranks)
        : options_(options),
          ranks_(ranks),
          renderer_(options),
          shares_(std::clamp(shares_of_a_rank * ranks.size(), 1,
                             static_cast<int>(share_blocks(renderer_.region()).size()))),
          queue_(shares_),
          shares_by_rank_(static_cast<std::size_t>(ranks.size())) {}

    int run() {
        make_parts_folder(options_);
        install_stop_signals();
        std::thread own([this] { render_own(); });
        hand_out();
        enough_ = 1;
        own.join();
        if (own_failure_) std::rethrow_exception(own_failure_);
        if (!queue_.is_done()) return report_stop();
        print_notes(notes_);
        ranks_.send_all(Kind::stop);  // merging may take longer than they would wait
        return merge();
    }

   private:
    /// Returns when all is rendered, this rank fails, or a stop signal comes.
    void hand_out() {
        while (stop_flag() == 0) {
            {
                const std::lock_guard lock(mutex_);
                if (queue_.is_done() || own_failure_) return;
            }
            if (const auto received = ranks_.receive()) answer(*received);
        }
    }

    void answer(const Ranks::Received& received) {
        const std::lock_guard lock(mutex_);
        const RankMessage& message = received.message;
        if (message.kind == Kind::failed) {
            notes_.push_back(printable(
                fmt::format("rank {} stopped rendering: {}", received.from, message.text.data())));
            if (message.turn) queue_.give_back(*message.turn);
            return;
        }
        if (message.kind == Kind::finished) finish_turn(*message.turn, received.from);
        RankMessage reply;
        reply.kind = Kind::wait;
        if (const auto turn = queue_.take(watch_.seconds())) {
            reply = {Kind::render, turn, shares_, {}};
        }
        ranks_.send(received.from, reply);
    }

    void finish_turn(const Turn& turn, int rank) {
        queue_.finish(turn, watch_.seconds());
        ++shares_by_rank_[static_cast<std::size_t>(rank)];
    }

    std::optional<Turn> take_own() {
        const std::lock_guard lock(mutex_);
        return queue_.take(watch_.seconds());
    }

    void render_own() try {
        while (enough_ == 0 && stop_flag() == 0) {
            const auto turn = take_own();
            if (!turn) {
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
                continue;
            }
            if (!renderer_.render(*turn, shares_, enough_)) return;
            const std::lock_guard lock(mutex_);
            finish_turn(*turn, 0);
        }
    } catch (...) {
        const std::lock_guard lock(mutex_);
        own_failure_ = std::current_exception();
    }

    int report_stop() const {
        print_note(fmt::format("{} after {} of {} shares; the same command resumes from there",
                               stop_reason(), queue_.finished().size(), shares_));
        return exit_code_of_stop(stop_flag());
    }

    int merge() const {
        MergeOptions merged;
        for (const Turn& turn : queue_.finished()) {
            merged.parts.push_back(part_name(options_, turn, shares_));
        }
        merged.output = options_.output;
        merged.encoding = options_.encoding;
        merged.quiet = options_.quiet;
        const int status = run_merge(merged);
        if (!options_.quiet) {
            print_note(
                fmt::format("shares rendered by each rank: {}", fmt::join(shares_by_rank_, " ")));
        }
        remove_parts(options_);
        return status;
    }

    const RenderOptions& options_;
    Ranks& ranks_;
    ShareRenderer renderer_;
    const int shares_;
    const Stopwatch watch_;
    StopFlag enough_{0};  ///< stops this rank's own rendering
    std::mutex mutex_;    ///< guards what follows
    ShareQueue queue_;
    std::vector<int> shares_by_rank_;
    std::vector<std::string> notes_;
    std::exception_ptr own_failure_;
};

}  // namespace

int host_ranks(const RenderOptions& options, Ranks& ranks) { return MpiHost(options, ranks).run(); }

}  // namespace rt
