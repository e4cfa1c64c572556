// SPDX-License-Identifier: Apache-2.0
#include "host/mpi/mpi_module.h"

#include <mpi.h>

#include <list>
#include <vector>

namespace {

bool start(int& rank, int& ranks) {
    int provided = 0;
    // Other threads render meanwhile; only the calling thread uses MPI.
    if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided) != MPI_SUCCESS)
        return false;
    // Losing a rank must not end the others.
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    return MPI_Comm_rank(MPI_COMM_WORLD, &rank) == MPI_SUCCESS &&
           MPI_Comm_size(MPI_COMM_WORLD, &ranks) == MPI_SUCCESS;
}

/// A message in transit; it stays so if its rank is lost.
struct Outgoing {
    std::vector<char> bytes;
    MPI_Request request = MPI_REQUEST_NULL;
};

std::list<Outgoing> outgoing;

bool has_left(Outgoing& message) {
    int is_done = 0;
    return MPI_Test(&message.request, &is_done, MPI_STATUS_IGNORE) != MPI_SUCCESS || is_done != 0;
}

bool send(int to, const void* bytes, std::size_t count) {
    outgoing.remove_if(has_left);
    const auto* first = static_cast<const char*>(bytes);
    Outgoing& message = outgoing.emplace_back(Outgoing{{first, first + count}});
    return MPI_Isend(message.bytes.data(), static_cast<int>(count), MPI_BYTE, to, 0, MPI_COMM_WORLD,
                     &message.request) == MPI_SUCCESS;
}

bool receive(int& from, void* bytes, std::size_t count) {
    int is_there = 0;
    MPI_Status status;
    if (MPI_Iprobe(MPI_ANY_SOURCE, 0, MPI_COMM_WORLD, &is_there, &status) != MPI_SUCCESS)
        return false;
    if (is_there == 0) return false;
    from = status.MPI_SOURCE;
    return MPI_Recv(bytes, static_cast<int>(count), MPI_BYTE, status.MPI_SOURCE, 0, MPI_COMM_WORLD,
                    MPI_STATUS_IGNORE) == MPI_SUCCESS;
}

void finish() { MPI_Finalize(); }

void abort_all(int status) { MPI_Abort(MPI_COMM_WORLD, status); }

}  // namespace

extern "C" [[gnu::visibility("default")]] const void* mirrorball_module() {
    static constexpr rt::MpiModule module{
        rt::MpiModule::current_version, start, send, receive, finish, abort_all};
    return &module;
}
