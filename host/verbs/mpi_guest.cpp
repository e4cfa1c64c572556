// SPDX-License-Identifier: Apache-2.0
#include "host/verbs/mpi_guest.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <exception>
#include <optional>
#include <string_view>
#include <thread>

#include "host/base/error.h"
#include "host/journal/share_queue.h"
#include "host/process/stop_signal.h"
#include "host/render/stopwatch.h"
#include "host/verbs/share_renderer.h"

namespace rt {

namespace {

using Kind = RankMessage::Kind;
using Turn = ShareQueue::Turn;

constexpr double longest_silence = 600;  ///< of rank 0, in seconds: it may be loading

class MpiGuest {
   public:
    MpiGuest(const RenderOptions& options, Ranks& ranks) : options_(options), ranks_(ranks) {}

    int run() {
        attempt({}, [&] {
            renderer_.emplace(options_);
            install_stop_signals();
            send(Kind::ready);
        });
        Stopwatch silence;
        while (stop_flag() == 0 || stop_flag() == SIGALRM) {  // rank 0 is out of time, too
            const auto received = ranks_.receive();
            if (received) {
                const Kind kind = received->message.kind;
                if (kind == Kind::finish) ranks_.finish();
                if (kind == Kind::finish || kind == Kind::quit) return 0;
                follow(received->message);
                silence.lap();
            } else if (is_rendering_ && silence.seconds() > longest_silence) {
                ranks_.abort(static_cast<int>(ExitCode::incomplete));  // rank 0 is lost
            }
        }
        return exit_code_of_stop(stop_flag());
    }

   private:
    void follow(const RankMessage& message) {
        if (message.kind == Kind::stop) {
            is_rendering_ = false;
            uninstall_stop_signals();
            return send(Kind::stopped);
        }
        if (message.kind == Kind::wait) {
            // Rank 0 then gets a thousand requests per second, however many ranks are idle.
            std::this_thread::sleep_for(std::chrono::milliseconds(std::max(20, ranks_.size())));
            return send(Kind::ready);
        }
        attempt(message, [&] {
            if (renderer_->render(*message.turn, message.shares, stop_flag())) {
                send(Kind::finished, message.turn);
            }
        });
    }

    /// Reports failures to rank 0, during a render or before any.
    template <typename Work>
    void attempt(RankMessage message, const Work& work) {
        try {
            return work();
        } catch (const std::exception& error) {
            std::string_view(error.what()).copy(message.text.data(), message.text.size() - 1);
        }
        is_rendering_ = false;
        message.kind = Kind::failed;
        ranks_.send(0, message);
    }

    void send(Kind kind, const std::optional<Turn>& turn = {}) {
        ranks_.send(0, {kind, turn, 0, {}});
    }

    const RenderOptions& options_;
    Ranks& ranks_;
    std::optional<ShareRenderer> renderer_;
    bool is_rendering_ = true;  ///< and rank 0 answers soon, unless it is lost
};

}  // namespace

int serve_rank_0(const RenderOptions& options, Ranks& ranks) {
    return MpiGuest(options, ranks).run();
}

}  // namespace rt
