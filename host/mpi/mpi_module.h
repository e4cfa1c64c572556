// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

/// The interface between the program and libmirrorball_mpi.so, which links MPI and so is built for
/// one MPI library. Plain C on purpose, like that of the picture modules. Functions return 1 for
/// success, 0 for failure. All are called by one thread.
namespace rt::mpi_module {

/// Raised whenever anything below changes; the program refuses a module of another version.
constexpr std::uint32_t interface_version = 1;
constexpr const char* entry_point_name = "mirrorball_mpi_module";

struct Module {
    std::uint32_t version;
    int (*start)(int* rank, int* ranks);
    /// Never waits for the receiver, which may be lost.
    int (*send)(int to, const void* bytes, std::size_t count);
    /// Whether a message of at most `count` bytes has arrived, from any rank; never waits.
    int (*receive)(int* from, void* bytes, std::size_t count);
    /// Waits for all ranks to call it. Nothing may be sent afterwards.
    void (*finish)();
    /// Ends all ranks at once, unresponsive ones included. Does not return.
    void (*abort)(int status);
};

}  // namespace rt::mpi_module
