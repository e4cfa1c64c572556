// SPDX-License-Identifier: Apache-2.0
#include "host/report/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>

#include "host/utf8.h"

namespace rt {

namespace {

constexpr const char* replacement = "\uFFFD";

/// What stands for a byte of well-formed UTF-8.
std::string escaped(char c) {
    switch (c) {
        case '&':
            return "&amp;";
        case '<':
            return "&lt;";
        case '>':
            return "&gt;";
        case '"':
            return "&quot;";
        case '\'':
            return "&#39;";
        default:
            break;
    }
    const auto code = static_cast<unsigned char>(c);
    const bool is_control = (code < 0x20 && c != '\t' && c != '\n') || code == 0x7f;
    return is_control ? replacement : std::string(1, c);
}

}  // namespace

std::string html_text(std::string_view text) {
    std::string html;
    while (!text.empty()) {
        const std::optional<std::size_t> bad = find_invalid_utf8(text);
        for (const char c : text.substr(0, bad.value_or(text.size()))) html += escaped(c);
        if (bad) html += replacement;
        text.remove_prefix(bad ? *bad + 1 : text.size());
    }
    return html;
}

std::string html_attribute(const char* name, std::string_view value) {
    return fmt::format(" {}=\"{}\"", name, html_text(value));
}

std::string png_data_uri(std::span<const std::byte> png) {
    constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text = "data:image/png;base64,";
    for (std::size_t i = 0; i < png.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            bits =
                bits << 8 | (i + k < png.size() ? std::to_integer<std::uint32_t>(png[i + k]) : 0);
        }
        const std::size_t real_digits = std::min<std::size_t>(png.size() - i, 3) + 1;
        for (std::size_t k = 0; k < 4; ++k) {
            text += k < real_digits ? digits[bits >> (18 - 6 * k) & 63] : '=';
        }
    }
    return text;
}

std::string json_block(const std::string& id, const nlohmann::ordered_json& json) {
    // "<" and "&" stand only in JSON's strings, where they may be written by number.
    std::string text;
    for (const char c :
         json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)) {
        if (c == '<') {
            text += "\\u003c";
        } else if (c == '&') {
            text += "\\u0026";
        } else {
            text += c;
        }
    }
    return fmt::format("<script type=\"application/json\"{}>{}</script>\n",
                       html_attribute("id", id), text);
}

std::string html_table(const HtmlTable& table) {
    std::string html = "<div class=\"scroll\" tabindex=\"0\" role=\"region\"" +
                       html_attribute("aria-label", table.caption) + "><table>\n<caption>" +
                       html_text(table.caption) + "</caption>\n<thead><tr>";
    for (const std::string& head : table.heads) {
        html += "<th scope=\"col\">" + html_text(head) + "</th>";
    }
    html += "</tr></thead>\n<tbody>\n";
    for (const auto& row : table.rows) {
        html += "<tr>";
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::string source =
                row[i].source.empty() ? "" : html_attribute("data-source", row[i].source);
            const std::string text = html_text(row[i].text);
            html += i == 0 ? fmt::format("<th scope=\"row\"{}>{}</th>", source, text)
                           : fmt::format("<td{}>{}</td>", source,
                                         row[i].strong ? "<strong>" + text + "</strong>" : text);
        }
        html += "</tr>\n";
    }
    return html + "</tbody></table></div>\n";
}

}  // namespace rt
