// SPDX-License-Identifier: Apache-2.0
#include "host/exit_status.h"

#include <cstdio>
#include <exception>
#include <new>
#include <system_error>

#include "host/console.h"
#include "host/error.h"

namespace rt {

namespace {

int failed(ExitCode code, const char* message) {
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
        const int status =
            failed(ExitCode::limit, "out of memory; render a smaller picture or scene");
        std::fflush(stdout);
        return status;
    } catch (const std::system_error& error) {
        return failed(ExitCode::limit, error.what());
    } catch (const std::exception& error) {
        return failed(ExitCode::bug, error.what());
    }
}

}  // namespace rt
