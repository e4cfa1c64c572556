// SPDX-License-Identifier: Apache-2.0
#include "host/process/exit_status.h"

#include <cstdio>
#include <exception>
#include <new>
#include <system_error>

#include "host/base/console.h"
#include "host/base/error.h"

namespace rt {

namespace {

/// Also prints the results so far: main ends without closing the streams.
int failed(ExitCode code, const char* message) {
    std::fflush(stdout);
    print_error(message);
    return static_cast<int>(code);
}

}  // namespace

int exit_status_of(const std::function<int()>& run) {
    try {
        return run();
    } catch (const Error& error) {
        return failed(error.exit_code(), error.what());
    } catch (const std::bad_alloc&) {
        return failed(ExitCode::limit, out_of_memory);
    } catch (const std::system_error& error) {
        return failed(ExitCode::limit, error.what());
    } catch (const std::exception& error) {
        return failed(ExitCode::bug, error.what());
    }
}

}  // namespace rt
