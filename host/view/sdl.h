// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>

// The few SDL 2 declarations that a window needs, loaded on demand: its development package pulls
// in fifty others, and its ABI has not changed since 2.0.0 (SDL_*.h of SDL2).
namespace rt::sdl {

struct Window;
struct Renderer;
struct Texture;

struct Box {
    int x, y, w, h;
};

/// SDL_Event: 56 bytes; only the key symbol is used.
union Event {
    std::uint32_t type;
    struct {
        std::uint32_t type, time, window;
        std::uint8_t state, repeat, padding[2];
        std::int32_t scancode, symbol;
    } key;
    std::uint8_t size[56];
};
static_assert(sizeof(Event) == 56);

constexpr std::uint32_t video = 0x20, quit = 0x100, key_down = 0x300;
constexpr int centered = 0x2FFF0000, resizable = 0x20;
constexpr std::int32_t escape = 27;
constexpr std::uint32_t rgb24 = 0x17101803;
constexpr int streaming = 1;

/// The library's functions, each without its SDL_ prefix.
struct Library {
    int (*SetHint)(const char* name, const char* value);
    int (*Init)(std::uint32_t flags);
    void (*Quit)();
    const char* (*GetError)();
    const char* (*GetCurrentVideoDriver)();
    int (*GetDisplayUsableBounds)(int display, Box* bounds);
    Window* (*CreateWindow)(const char* title, int x, int y, int w, int h, std::uint32_t flags);
    void (*SetWindowTitle)(Window*, const char* title);
    void (*DestroyWindow)(Window*);
    Renderer* (*CreateRenderer)(Window*, int index, std::uint32_t flags);
    int (*RenderSetLogicalSize)(Renderer*, int w, int h);
    Texture* (*CreateTexture)(Renderer*, std::uint32_t format, int access, int w, int h);
    void (*DestroyTexture)(Texture*);
    int (*UpdateTexture)(Texture*, const Box* part, const void* pixels, int pitch);
    int (*RenderClear)(Renderer*);
    int (*RenderCopy)(Renderer*, Texture*, const Box* from, const Box* to);
    void (*RenderPresent)(Renderer*);
    int (*PollEvent)(Event*);
};

/// Null if SDL is not installed or the X server was lost; `why` says so.
const Library* load(std::string& why);

/// For `survives`: call it after Init, which loads Xlib.
void expect_loss();

/// Calls SDL's functions. Returns false if the X server is lost, on which Xlib would end the
/// program: SDL must not be called again then. `calls` is left by longjmp, so it must
/// create nothing that has a destructor.
bool survives(const std::function<void()>& calls);

}  // namespace rt::sdl
