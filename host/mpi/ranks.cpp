// SPDX-License-Identifier: Apache-2.0
#include "host/mpi/ranks.h"

#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <thread>
#include <type_traits>

#include "host/base/error.h"
#include "host/base/module_file.h"

namespace rt {

namespace {

static_assert(std::is_trivially_copyable_v<RankMessage>);  // sent as raw bytes

const MpiModule& load_mpi() {
    return *static_cast<const MpiModule*>(
        load_module({"libmirrorball_mpi.so", MpiModule::current_version, "MPI",
                     "--mpi requires libopenmpi3, and mirrorball built with libopenmpi-dev"},
                    ExitCode::usage));
}

}  // namespace

void check_mpi() { load_mpi(); }

Ranks::Ranks() : mpi_(load_mpi()) {
    if (!mpi_.start(rank_, size_)) {
        usage_error("--mpi: MPI did not start; launch mirrorball with mpirun");
    }
}

void Ranks::send(int to, const RankMessage& message) {
    // Errors are ignored: only messages to lost ranks fail.
    static_cast<void>(mpi_.send(to, &message, sizeof message));
}

void Ranks::send_all(RankMessage::Kind kind) {
    for (int to = 1; to < size_; ++to) send(to, {kind, {}, 0, {}});
}

std::optional<Ranks::Received> Ranks::receive() {
    Received received{};
    if (!mpi_.receive(received.from, &received.message, sizeof received.message)) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return std::nullopt;
    }
    return received;
}

bool Ranks::may_end_alone() { return std::getenv("OMPI_MCA_orte_enable_recovery") != nullptr; }

void Ranks::abort(int status) {
    if (!may_end_alone()) mpi_.abort(status);
    _exit(status);
}

}  // namespace rt
