/// bough kinematics razi: the parts of the acceleration of a point in frames that turn in each other.
#include <algorithm>
#include <iostream>

#include "arguments.hpp"
#include "bough/io/atomic_file.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/read_frames.hpp"
#include "bough/report/split_plot.hpp"
#include "bough/study/frames.hpp"
#include "result_text.hpp"
#include "terminal.hpp"

namespace bough::app {
namespace {

study::DiscStudy disc_of(const RaziArguments& arguments) {
  study::DiscStudy disc;
  if (arguments.spin && arguments.precession) disc.speeds = {{*arguments.spin, *arguments.precession}};
  disc.tilt_deg = arguments.tilt.value_or(disc.tilt_deg);
  disc.radius = arguments.radius.value_or(disc.radius);
  disc.num_points = arguments.points.value_or(disc.num_points);
  return disc;
}

/// The parameters of each series and the largest magnitude of each part.
std::string largest_text(const io::SplitTable& table) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> head;
  for (const auto& [name, value] : table.series.front().parameters) head.push_back(name);
  for (const io::Part part : table.columns) head.emplace_back(io::part_names[static_cast<std::size_t>(part)]);
  rows.push_back(std::move(head));
  for (const io::SplitSeries& series : table.series) {
    std::vector<std::string> cells;
    for (const auto& [name, value] : series.parameters) cells.push_back(io::rounded_text(value, 6));
    for (const io::Part part : table.columns) {
      double largest = 0.0;
      for (const io::SplitRow& row : series.rows) largest = std::max(largest, row.magnitude(part));
      cells.push_back(io::rounded_text(largest, 6));
    }
    rows.push_back(std::move(cells));
  }
  return table.title + "\nlargest magnitudes [m/s^2], seen from " + table.seen_from + "\n" + table_text(rows);
}

void write_to(const std::filesystem::path& path, const std::string& text) {
  if (!path.empty()) io::write_file(path, text);
}

}  // namespace

int kinematics_razi(const RaziArguments& arguments) {
  io::SplitTable table;
  if (arguments.chain.empty()) {
    table = study::split_disc(disc_of(arguments));
  } else {
    const io::FrameFile file = io::read_frames(arguments.chain);
    print_problems(arguments.chain, file.problems, file.warnings);
    if (!file.ok()) return exit_bad_input;
    table = study::split_frames(file.study);
  }
  write_to(arguments.files.csv, io::split_csv(table));
  write_to(arguments.files.json, io::split_json(table));
  write_to(arguments.files.svg, report::split_svg(table));
  std::cout << largest_text(table);
  for (const std::filesystem::path& path : {arguments.files.csv, arguments.files.json, arguments.files.svg})
    if (!path.empty()) std::cout << path.string() << "\n";
  return exit_done;
}

}  // namespace bough::app
