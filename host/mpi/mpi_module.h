// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

/// The interface between the program and libmirrorball_mpi.so, which links MPI and so is built for
/// one MPI library. Functions return whether they succeeded. All are called by one thread.
namespace rt {

struct MpiModule {
    /// Raised whenever anything below changes; the program refuses a module of another version.
    static constexpr std::uint32_t current_version = 2;

    std::uint32_t version;
    bool (*start)(int& rank, int& ranks);
    /// Never waits for the receiver, which may be lost.
    bool (*send)(int to, const void* bytes, std::size_t count);
    /// Whether a message of at most `count` bytes has arrived, from any rank; never waits.
    bool (*receive)(int& from, void* bytes, std::size_t count);
    /// Waits for all ranks to call it. Nothing may be sent afterwards.
    void (*finish)();
    /// Ends all ranks at once, unresponsive ones included. Does not return.
    void (*abort)(int status);
};

}  // namespace rt
