#pragma once
/// Self-contained pages of text, tables and charts: one file, no network, no scripts but a page's own; light, dark and
/// printed.
#include <string>
#include <string_view>
#include <vector>

#include "bough/report/chart.hpp"

namespace bough::report {

enum class Tone { plain, good, bad, soft };

/// One cell of a table. All text is escaped by the page.
struct Cell {
  std::string text;
  Tone tone = Tone::plain;
  bool is_number = false;   ///< aligned to the right
  std::string source = {};  ///< JSON pointer to the value in the file that belongs to the page; checks compare the two
  std::string link = {};    ///< relative address; empty: none
};

/// A number with at most `digits` significant digits; "-" where it is NaN.
Cell number_cell(double value, int digits = 4, std::string source = {}, Tone tone = Tone::plain);

struct Table {
  std::vector<std::string> head;
  std::vector<std::vector<Cell>> rows;  ///< each as long as the head
  std::string caption = {};
};

/// A page in the order of the calls.
class Document {
 public:
  /// lead: one or two sentences under the title. data: name of the JSON file beside the page to which `source`
  /// pointers refer; may be empty.
  explicit Document(std::string title, std::string_view lead = {}, std::string_view data = {});

  void section(std::string_view heading, std::string_view anchor = {});
  void subsection(std::string_view heading);
  void paragraph(std::string_view text, Tone tone = Tone::plain);
  void list(const std::vector<std::string>& items);
  void table(const Table& table);  ///< precondition: every row is as long as the head
  /// A table behind a line that opens it; on paper it is open.
  void folded(std::string_view line, const Table& table, bool is_open);
  void charts(const std::vector<Chart>& charts);
  void figure(std::string_view svg, std::string_view caption = {});  ///< a drawing of one's own; svg is taken as it is

  void markup(std::string_view html);  ///< of one's own, taken as it is

  void figures(const std::vector<std::string>& svgs);  ///< drawings of one's own beside each other
  /// Data, and a script that reads them from the element with this id, at the end of the page. The page permits this
  /// script only, by its hash.
  void program(std::string_view id, std::string_view json, std::string_view script);

  std::string html() const;  ///< the whole page

 private:
  std::string title_, body_, program_, program_hash_;
};

}  // namespace bough::report
