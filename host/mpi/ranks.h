// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "host/journal/share_queue.h"
#include "host/mpi/mpi_module.h"

namespace rt {

/// A message between ranks.
struct RankMessage {
    enum class Kind : std::int32_t {
        ready,     ///< to rank 0: give me a share
        finished,  ///< to rank 0: the turn is done; give me another share
        failed,    ///< to rank 0: the turn, if any, will never be done, for the reason in `text`
        render,    ///< from rank 0: do this turn
        wait,      ///< from rank 0: nothing to do now; ask again
        stop,      ///< from rank 0: nothing more to do
        stopped,   ///< to rank 0
        finish,    ///< from rank 0: end MPI, as all ranks do now
        quit,      ///< from rank 0: end at once, because another rank does not answer
    };

    Kind kind = Kind::ready;
    std::optional<ShareQueue::Turn> turn;
    int shares = 0;                ///< that the picture is cut into; of `render` only
    std::array<char, 512> text{};  ///< ends with a zero
};

/// Throws Error (ExitCode::usage) if MPI is missing. Does not start it.
void check_mpi();

/// The processes that mpirun started, as seen by one of them. Loads MPI. Only the thread that
/// created it may use it.
class Ranks {
   public:
    /// Throws Error (ExitCode::usage) if MPI is missing or does not start.
    Ranks();

    int rank() const { return rank_; }
    int size() const { return size_; }

    void send(int to, const RankMessage& message);

    /// Sends to every rank but 0.
    void send_all(RankMessage::Kind kind);

    struct Received {
        int from;
        RankMessage message;
    };

    /// The next message, if one has arrived; else pauses for a millisecond.
    std::optional<Received> receive();

    /// Ends MPI; waits for every rank to do so.
    void finish() { mpi_.finish(); }

    /// Whether mpirun lets the other ranks continue when one ends (--enable-recovery). It may then
    /// wait forever for ranks of an aborted job, but not for ranks that exit.
    static bool may_end_alone();

    /// Ends every rank, unresponsive ones included; with may_end_alone(), only this one.
    [[noreturn]] void abort(int status);

   private:
    const MpiModule& mpi_;
    int rank_ = 0, size_ = 1;
};

}  // namespace rt
