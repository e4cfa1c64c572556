// SPDX-License-Identifier: Apache-2.0
#include "host/view/sdl.h"

#include <dlfcn.h>
#include <unistd.h>

#include <csetjmp>

namespace rt::sdl {

namespace {

bool is_lost = false;
thread_local std::jmp_buf* way_out = nullptr;

/// Xlib's handler of I/O errors, which must not return.
int leave(void*) {
    if (way_out != nullptr) std::longjmp(*way_out, 1);
    for (;;) ::pause();  // a driver's own thread
}

}  // namespace

const Library* load(std::string& why) {
    if (is_lost) {
        why = "the X server is not running";
        return nullptr;
    }
    void* const handle = dlopen("libSDL2-2.0.so.0", RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
        why = "SDL 2 is missing: install libsdl2-2.0-0";
        return nullptr;
    }
    static Library library;
    const auto find = [&](auto& function, const char* name) {
        function =
            reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(handle, name));
        if (function == nullptr) why = std::string("SDL 2 has no ") + name;
    };
    find(library.SetHint, "SDL_SetHint");
    find(library.Init, "SDL_Init");
    find(library.Quit, "SDL_Quit");
    find(library.GetError, "SDL_GetError");
    find(library.GetCurrentVideoDriver, "SDL_GetCurrentVideoDriver");
    find(library.GetDisplayUsableBounds, "SDL_GetDisplayUsableBounds");
    find(library.CreateWindow, "SDL_CreateWindow");
    find(library.SetWindowTitle, "SDL_SetWindowTitle");
    find(library.DestroyWindow, "SDL_DestroyWindow");
    find(library.CreateRenderer, "SDL_CreateRenderer");
    find(library.RenderSetLogicalSize, "SDL_RenderSetLogicalSize");
    find(library.CreateTexture, "SDL_CreateTexture");
    find(library.DestroyTexture, "SDL_DestroyTexture");
    find(library.UpdateTexture, "SDL_UpdateTexture");
    find(library.RenderClear, "SDL_RenderClear");
    find(library.RenderCopy, "SDL_RenderCopy");
    find(library.RenderPresent, "SDL_RenderPresent");
    find(library.PollEvent, "SDL_PollEvent");
    return why.empty() ? &library : nullptr;
}

void expect_loss() {
    void* const xlib = dlopen("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
    if (xlib == nullptr) return;
    using SetHandler = void* (*)(int (*)(void*));
    const auto set = reinterpret_cast<SetHandler>(dlsym(xlib, "XSetIOErrorHandler"));
    if (set != nullptr) set(leave);
    dlclose(xlib);
}

bool survives(const std::function<void()>& calls) {
    std::jmp_buf here;
    if (setjmp(here) != 0) {
        is_lost = true;
        return false;
    }
    way_out = &here;
    calls();
    way_out = nullptr;
    return true;
}

}  // namespace rt::sdl
