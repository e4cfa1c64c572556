// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace rt {

/// Text escaped for an HTML element or a quoted attribute: & < > " ' become entities; control
/// characters and invalid UTF-8 become U+FFFD.
std::string html_text(std::string_view text);

/// "name="value"" with a space before it; the value is escaped.
std::string html_attribute(const char* name, std::string_view value);

/// A PNG file as a data URI.
std::string png_data_uri(std::span<const std::byte> png);

/// Data embedded in the page: <script type="application/json" id="...">. No text in it can end the
/// element.
std::string json_block(const std::string& id, const nlohmann::ordered_json& json);

/// One cell of a table. Texts are escaped.
struct HtmlCell {
    std::string text;
    std::string source = {};  ///< where the number comes from: "bench#/runs/3"; empty: none
    bool strong = false;
    std::optional<double> drawn = std::nullopt;  ///< a bar of this share of its full length
};

/// A table with a caption, column heads and, in the first cell of each row, row heads. Columns of
/// numbers are aligned at their decimal points, others at the left.
struct HtmlTable {
    std::string caption;
    std::vector<std::string> heads;
    std::vector<std::vector<HtmlCell>> rows;
};

std::string html_table(const HtmlTable& table);

}  // namespace rt
