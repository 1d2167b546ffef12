#include "bough/report/document.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bough/report/picture.hpp"
#include "packed.hpp"
#include "page_style.hpp"
#include "svg_text.hpp"

namespace bough::report {
namespace {

std::string_view class_of(Tone tone) {
  switch (tone) {
    case Tone::good:
      return "good";
    case Tone::bad:
      return "bad";
    case Tone::soft:
      return "soft-text";
    case Tone::plain:
      break;
  }
  return {};
}

std::string attribute(std::string_view name, std::string_view value) {
  return value.empty() ? std::string() : " " + std::string(name) + "=\"" + escaped(value) + "\"";
}

/// label: the text before the cell where a row is shown as a card; empty if rows are not shown as cards.
std::string cell_html(const Cell& cell, std::string_view label) {
  std::string classes(cell.is_number ? "number" : "");
  if (const std::string_view tone = class_of(cell.tone); !tone.empty())
    classes += (classes.empty() ? "" : " ") + std::string(tone);
  const std::string text =
      cell.link.empty() ? escaped(cell.text) : "<a" + attribute("href", cell.link) + ">" + escaped(cell.text) + "</a>";
  return "<td" + attribute("class", classes) + attribute("data-source", cell.source) + attribute("data-label", label) +
         ">" + text + "</td>";
}

/// Length of the longest word.
std::size_t longest_word(std::string_view text) {
  std::size_t most = 0;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    most = std::max(most, end - begin);
    begin = end + 1;
  }
  return most;
}

/// Minimum width of a column, in wide letters: numbers cannot be wrapped, and words only between them.
double least_width(const Table& table, std::size_t c) {
  constexpr double letter = 8.8, bold_letter = 9.6, padding = 14.0, first_column = 9.0 * 15.0;  // [px] at 15 px
  double width = bold_letter * static_cast<double>(longest_word(table.head[c]));
  for (const std::vector<Cell>& row : table.rows)
    width = std::max(width,
                     letter * static_cast<double>(row[c].is_number ? row[c].text.size() : longest_word(row[c].text)));
  return padding + (c == 0 ? std::max(width, first_column) : width);
}

/// Divides columns into parts that fit into a width; each part begins with the first column.
std::vector<std::vector<std::size_t>> parts_within(const std::vector<double>& widths, double widest) {
  std::vector<std::vector<std::size_t>> parts(1);
  double used = 0.0;
  for (std::size_t c = 0; c < widths.size(); ++c) {
    if (used + widths[c] > widest && parts.back().size() > 1) {
      parts.push_back({0});
      used = widths[0];
    }
    parts.back().push_back(c);
    used += widths[c];
  }
  return parts;
}

/// Divides a table into parts that fit on the page and, with letters of four fifths of the size, on paper of 190 mm.
/// There are as few parts as possible, as equal in width as possible.
std::vector<std::vector<std::size_t>> parts_of(const Table& table) {
  constexpr double widest = 860.0, step = 10.0;  // [px]
  std::vector<double> widths;
  for (std::size_t c = 0; c < table.head.size(); ++c) widths.push_back(least_width(table, c));
  std::vector<std::vector<std::size_t>> parts = parts_within(widths, widest);
  for (double width = widest - step; width > 0.0; width -= step) {
    std::vector<std::vector<std::size_t>> narrower = parts_within(widths, width);
    if (narrower.size() > parts.size()) break;
    parts = std::move(narrower);
  }
  return parts;
}

/// Rows of a table as cards in windows up to a width.
std::string cards_style(std::string_view width, const std::string& table) {
  std::string rules = "@media screen and (max-width:" + std::string(width) + "){";
  rules += table + " thead{display:none}" + table + "," + table + " caption," + table + " tbody," + table +
           " tr{display:block}";
  rules += table + " tr{padding:6px 0;border-bottom:1px solid #a9a8a0}";
  rules += table +
           " td{display:flex;gap:12px;justify-content:space-between;min-width:0;padding:1px "
           "0;border:0;overflow-wrap:anywhere;white-space:normal}";
  return rules + table + " td::before{content:attr(data-label);color:#52514e;flex:none;max-width:50%}}\n";
}

}  // namespace

Cell number_cell(double value, int digits, std::string source, Tone tone) {
  return {std::isnan(value) ? "-" : io::rounded_text(value, digits), tone, true, std::move(source)};
}

Document::Document(std::string title, std::string_view lead, std::string_view data)
    : title_(std::move(title)),
      body_("<main" + attribute("data-file", data) + ">\n<h1>" + escaped(title_) + "</h1>\n") {
  if (!lead.empty()) body_ += "<p class=\"lead\">" + escaped(lead) + "</p>\n";
}

void Document::section(std::string_view heading, std::string_view anchor) {
  body_ += "<h2" + attribute("id", anchor) + ">" + escaped(heading) + "</h2>\n";
}

void Document::subsection(std::string_view heading) { body_ += "<h3>" + escaped(heading) + "</h3>\n"; }

void Document::paragraph(std::string_view text, Tone tone) {
  body_ += "<p" + attribute("class", class_of(tone)) + ">" + escaped(text) + "</p>\n";
}

void Document::list(const std::vector<std::string>& items) {
  body_ += "<ul>\n";
  for (const std::string& item : items) body_ += "<li>" + escaped(item) + "</li>\n";
  body_ += "</ul>\n";
}

void Document::table(const Table& table) {
  for (const std::vector<Cell>& row : table.rows)
    if (row.size() != table.head.size()) throw std::logic_error("a row is as long as the head of its table");
  const std::vector<std::vector<std::size_t>> parts = parts_of(table);
  for (const std::vector<std::size_t>& columns : parts) {
    // If the window is narrower than such a table, rows are shown as cards with one line for each column, so that
    // nothing is cut off.
    double width = 0.0;
    for (const std::size_t c : columns) width += least_width(table, c);
    const bool has_cards = width > 340.0;
    const std::string_view kind = width > 580.0 ? " class=\"cards large\"" : has_cards ? " class=\"cards\"" : "";
    body_ += "<div class=\"wide\"><table" + std::string(kind) + ">\n";
    if (!table.caption.empty() && &columns == &parts.front())
      body_ += "<caption>" + escaped(table.caption) + "</caption>\n";
    body_ += "<thead><tr>";
    for (const std::size_t c : columns) {
      const bool is_number = !table.rows.empty() && table.rows.front()[c].is_number;
      body_ += std::string(is_number ? "<th class=\"number\">" : "<th>") + escaped(table.head[c]) + "</th>";
    }
    body_ += "</tr></thead>\n<tbody>\n";
    for (const std::vector<Cell>& row : table.rows) {
      body_ += "<tr>";
      for (const std::size_t c : columns) body_ += cell_html(row[c], has_cards ? table.head[c] : std::string());
      body_ += "</tr>\n";
    }
    body_ += "</tbody></table></div>\n";
  }
}

void Document::folded(std::string_view line, const Table& table, bool is_open) {
  body_ += std::string("<details") + (is_open ? " open" : "") + "><summary>" + escaped(line) + "</summary>\n";
  this->table(table);
  body_ += "</details>\n";
}

void Document::charts(const std::vector<Chart>& charts) {
  body_ += "<div class=\"charts\">\n";
  for (const Chart& chart : charts) body_ += "<figure>\n" + chart_svg(chart) + "</figure>\n";
  body_ += "</div>\n";
}

void Document::figure(std::string_view svg, std::string_view caption) {
  body_ += "<figure>\n" + std::string(svg);
  if (!caption.empty()) body_ += "<figcaption>" + escaped(caption) + "</figcaption>";
  body_ += "</figure>\n";
}

void Document::markup(std::string_view html) { body_ += html; }

void Document::figures(const std::vector<std::string>& svgs) {
  body_ += "<div class=\"charts\">\n";
  for (const std::string& svg : svgs) figure(svg);
  body_ += "</div>\n";
}

void Document::program(std::string_view id, std::string_view json, std::string_view script) {
  program_ = "<script type=\"application/json\" id=\"" + escaped(id) + "\">" + inside_script(json) +
             "</script>\n<script>" + std::string(script) + "</script>\n";
  program_hash_ = base64(sha256(script));
}

std::string Document::html() const {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'" +
         (program_.empty() ? std::string() : "; script-src 'sha256-" + program_hash_ + "'") +
         "\">\n"
         "<title>" +
         escaped(title_) + "</title>\n<style>" + std::string(page_style) + cards_style("640px", ".cards") +
         cards_style("920px", ".cards.large") + std::string(style_text()) + "</style>\n</head>\n<body>\n" + body_ +
         "</main>\n" + program_ + "</body>\n</html>\n";
}

}  // namespace bough::report
