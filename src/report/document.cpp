#include "bough/report/document.hpp"

#include <cmath>
#include <stdexcept>

#include "bough/report/picture.hpp"
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

std::string cell_html(const Cell& cell) {
  std::string classes(cell.is_number ? "number" : "");
  if (const std::string_view tone = class_of(cell.tone); !tone.empty())
    classes += (classes.empty() ? "" : " ") + std::string(tone);
  const std::string text =
      cell.link.empty() ? escaped(cell.text) : "<a" + attribute("href", cell.link) + ">" + escaped(cell.text) + "</a>";
  return "<td" + attribute("class", classes) + attribute("data-source", cell.source) + ">" + text + "</td>";
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
  body_ += "<div class=\"wide\"><table>\n";
  if (!table.caption.empty()) body_ += "<caption>" + escaped(table.caption) + "</caption>\n";
  body_ += "<thead><tr>";
  for (std::size_t c = 0; c < table.head.size(); ++c) {
    const bool is_number = !table.rows.empty() && c < table.rows.front().size() && table.rows.front()[c].is_number;
    body_ += std::string(is_number ? "<th class=\"number\">" : "<th>") + escaped(table.head[c]) + "</th>";
  }
  body_ += "</tr></thead>\n<tbody>\n";
  for (const std::vector<Cell>& row : table.rows) {
    if (row.size() != table.head.size()) throw std::logic_error("a row is as long as the head of its table");
    body_ += "<tr>";
    for (const Cell& cell : row) body_ += cell_html(cell);
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div>\n";
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

std::string Document::html() const {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\n"
         "<title>" +
         escaped(title_) + "</title>\n<style>" + std::string(page_style) + std::string(style_text()) +
         "</style>\n</head>\n<body>\n" + body_ + "</main>\n</body>\n</html>\n";
}

}  // namespace bough::report
