// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <string_view>

#include "host/scene/mistakes.h"

namespace rt {

/// A word or number of an NFF text; empty at the end of the text.
struct NffToken {
    std::string_view text;
    std::size_t offset = 0;
    bool first_on_line = false;

    bool is_number() const;  ///< or begins like one
};

/// Splits an NFF text into words and numbers; line ends are blanks, and comments (from # to the end
/// of the line) are skipped. Every read_ function notes in `mistakes` why the next token is
/// invalid, does not consume a word, and then returns nothing.
class NffTokens {
   public:
    explicit NffTokens(Mistakes& mistakes);

    const NffToken& peek() const { return token_; }
    NffToken take();
    std::size_t bytes_left() const { return text_.size() - token_.offset; }

    /// The syntax of the entity being read, for messages: "s x y z radius".
    void expect(std::string_view usage) { usage_ = usage; }

    std::optional<double> read_number(std::string_view name);
    std::optional<double> read_not_negative(std::string_view name);
    std::optional<int> read_integer(std::string_view name, int low, int high);
    std::optional<glm::dvec3> read_vec3(std::string_view name);
    std::optional<glm::dvec3> read_color(std::string_view name);

   private:
    void scan();
    bool has_number(std::string_view name);

    Mistakes& mistakes_;
    std::string_view text_;
    std::size_t at_ = 0;
    NffToken token_;
    std::string_view usage_;
};

}  // namespace rt
