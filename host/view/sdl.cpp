// SPDX-License-Identifier: Apache-2.0
#include "host/view/sdl.h"

#include <dlfcn.h>

namespace rt::sdl {

const Library* load(std::string& why) {
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
    find(library.GetDisplayUsableBounds, "SDL_GetDisplayUsableBounds");
    find(library.CreateWindow, "SDL_CreateWindow");
    find(library.SetWindowTitle, "SDL_SetWindowTitle");
    find(library.DestroyWindow, "SDL_DestroyWindow");
    find(library.CreateRenderer, "SDL_CreateRenderer");
    find(library.RenderSetLogicalSize, "SDL_RenderSetLogicalSize");
    find(library.CreateTexture, "SDL_CreateTexture");
    find(library.UpdateTexture, "SDL_UpdateTexture");
    find(library.RenderClear, "SDL_RenderClear");
    find(library.RenderCopy, "SDL_RenderCopy");
    find(library.RenderPresent, "SDL_RenderPresent");
    find(library.PollEvent, "SDL_PollEvent");
    return why.empty() ? &library : nullptr;
}

}  // namespace rt::sdl
