// SPDX-License-Identifier: Apache-2.0
#include "host/verbs/render_mpi.h"

#include <set>

#include "host/image/picture_io.h"
#include "host/mpi/ranks.h"
#include "host/process/exit_status.h"
#include "host/process/stop_signal.h"
#include "host/render/stopwatch.h"
#include "host/verbs/mpi_guest.h"
#include "host/verbs/mpi_host.h"

namespace rt {

namespace {

using Kind = RankMessage::Kind;

constexpr double longest_farewell = 2, time_to_quit = 0.1;  ///< seconds

/// Whether all ranks confirm that they stopped.
bool stop_all(Ranks& ranks) {
    ranks.send_all(Kind::stop);
    std::set<int> stopped;
    const Stopwatch watch;
    while (static_cast<int>(stopped.size()) < ranks.size() - 1 &&
           watch.seconds() < longest_farewell) {
        const auto received = ranks.receive();
        if (received && received->message.kind == Kind::stopped) stopped.insert(received->from);
    }
    return static_cast<int>(stopped.size()) == ranks.size() - 1;
}

/// Ends MPI, by force if a rank does not answer.
void dismiss(Ranks& ranks, int status) {
    uninstall_stop_signals();
    if (stop_all(ranks)) {
        ranks.send_all(Kind::finish);
        return ranks.finish();
    }
    if (Ranks::may_end_alone()) ranks.send_all(Kind::quit);
    const Stopwatch watch;
    while (watch.seconds() < time_to_quit) ranks.receive();
    ranks.abort(status);
}

}  // namespace

int render_mpi(const RenderOptions& options) {
    if (options.timeout > 0) stop_after(options.timeout);
    Ranks ranks;
    if (ranks.rank() != 0) return serve_rank_0(options, ranks);
    const int status = exit_status_of([&] {
        check_picture_path(options.output);
        return host_ranks(options, ranks);
    });
    dismiss(ranks, status);
    return status;
}

}  // namespace rt
