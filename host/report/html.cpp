// SPDX-License-Identifier: Apache-2.0
#include "host/report/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>

#include "host/base/text.h"

namespace rt {

namespace {

constexpr const char* replacement = "\uFFFD";
constexpr std::size_t long_text = 40;  ///< bytes beyond which a cell's lines may break

/// The HTML for one byte of well-formed UTF-8.
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

/// "12.3", "1.9·10⁻⁷" or "43 %".
bool is_number(std::string_view text) {
    if (text.empty() || text.front() < '0' || text.front() > '9') return false;
    const std::string_view rest =
        text.substr(std::min(text.find_first_not_of("0123456789."), text.size()));
    return rest.empty() || rest.starts_with("·10") || rest == " %";
}

/// Digits after the decimal point.
std::size_t decimals_of(std::string_view number) {
    const auto point = number.find('.');
    if (point == std::string_view::npos) return 0;
    const auto end = std::min(number.find_first_not_of("0123456789", point + 1), number.size());
    return end - point - 1;
}

/// How a column is formatted: as numbers if at least half of its texts are.
struct Column {
    bool is_numeric = false;
    std::size_t decimals = 0;
};

Column column_of(const HtmlTable& table, std::size_t column) {
    std::size_t texts = 0, numbers = 0;
    Column found;
    for (const auto& row : table.rows) {
        if (column >= row.size() || row[column].text.empty()) continue;
        ++texts;
        if (!is_number(row[column].text)) continue;
        ++numbers;
        found.decimals = std::max(found.decimals, decimals_of(row[column].text));
    }
    found.is_numeric = column > 0 && numbers > 0 && 2 * numbers >= texts;
    return found;
}

/// Digits that pad a number to the column's decimals; the style makes them invisible.
std::string padding(const std::string& text, const Column& column) {
    if (!is_number(text) || column.decimals == 0) return "";
    const std::size_t decimals = decimals_of(text);
    return (decimals == 0 ? "." : "") + std::string(column.decimals - decimals, '0');
}

std::string drawn_bar(double share) {
    return fmt::format(
        "<svg class=\"share\" viewBox=\"0 0 100 10\" aria-hidden=\"true\"><rect class=\"whole\" "
        "width=\"100\" height=\"10\"/><rect width=\"{:.1f}\" height=\"10\"/></svg>",
        100 * std::clamp(share, 0.0, 1.0));
}

std::string cell_html(const HtmlCell& cell, const Column& column, bool is_head) {
    std::string attributes = cell.source.empty() ? "" : html_attribute("data-source", cell.source);
    std::string text = html_text(cell.text);
    if (is_head) return fmt::format("<th scope=\"row\"{}>{}</th>", attributes, text);
    if (column.is_numeric) {
        const bool is_short = is_number(cell.text) || cell.text.size() < 6;
        attributes += html_attribute("class", cell.drawn ? "number drawn"
                                              : is_short ? "number"
                                                         : "number words");
        const std::string pad = padding(cell.text, column);
        if (!pad.empty()) attributes += html_attribute("data-pad", pad);
    } else if (cell.text.size() > long_text) {
        attributes += html_attribute("class", "long");
    }
    if (cell.strong) text = "<strong>" + text + "</strong>";
    if (cell.drawn) text = drawn_bar(*cell.drawn) + " " + text;
    return fmt::format("<td{}>{}</td>", attributes, text);
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
    return "data:image/png;base64," + base64(png);
}

std::string json_block(const std::string& id, const nlohmann::ordered_json& json) {
    // In JSON, "<" and "&" occur only in strings, where they can be escaped by number.
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
    std::vector<Column> columns;
    for (std::size_t i = 0; i < table.heads.size(); ++i) {
        columns.push_back(column_of(table, i));
        html += fmt::format("<th scope=\"col\"{}>{}</th>",
                            columns[i].is_numeric ? html_attribute("class", "number") : "",
                            html_text(table.heads[i]));
    }
    html += "</tr></thead>\n<tbody>\n";
    for (const auto& row : table.rows) {
        html += "<tr>";
        for (std::size_t i = 0; i < row.size(); ++i) html += cell_html(row[i], columns[i], i == 0);
        html += "</tr>\n";
    }
    return html + "</tbody></table></div>\n";
}

}  // namespace rt
