/// bough kinematics razi: the parts of the acceleration of a point in frames that turn in each other.
/// bough kinematics motion: everything about one motion.
#include <algorithm>
#include <cmath>
#include <iostream>

#include "arguments.hpp"
#include "bough/io/atomic_file.hpp"
#include "bough/io/manifest.hpp"
#include "bough/io/motion_report.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/read_frames.hpp"
#include "bough/io/read_motion.hpp"
#include "bough/study/frames.hpp"
#include "pages.hpp"
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

/// Poses given as numbers; false, with a message, where one is none.
bool read_poses(const MotionArguments& arguments, io::MotionInput& input) {
  const auto good = [](const char* option, const std::vector<double>& numbers, motion::Frame<double>& pose) {
    const std::string fault = io::read_pose(numbers, pose);
    if (!fault.empty()) std::cerr << "bough: " << option << ": " << fault << "\n";
    return fault.empty();
  };
  input.seen_from = arguments.seen_from == "first" ? motion::SeenFrom::first : motion::SeenFrom::inertial;
  bool all_good = good("--to", arguments.to, input.to);
  if (!arguments.from.empty()) all_good = good("--from", arguments.from, input.from.emplace()) && all_good;
  return all_good;
}

void write_to(const std::filesystem::path& path, const std::string& text) {
  if (!path.empty()) io::write_file(path, text);
}

}  // namespace

int kinematics_razi(const RaziArguments& arguments) {
  if (!arguments.files.svg.empty() && !can_draw("--svg")) return exit_bad_input;
  io::refuse_to_overwrite({arguments.chain}, {arguments.files.csv, arguments.files.json, arguments.files.svg});
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
  if (!arguments.files.svg.empty()) write_split_picture(arguments.files.svg, table);
  std::cout << largest_text(table);
  for (const std::filesystem::path& path : {arguments.files.csv, arguments.files.json, arguments.files.svg})
    if (!path.empty()) std::cout << path.string() << "\n";
  return exit_done;
}

namespace {

/// Name of the first row of a table with a number that is not finite; empty: there is none. Further rows of a matrix
/// have no name of their own.
std::string first_not_finite(const std::vector<std::vector<std::string>>& rows) {
  std::string name;
  for (const std::vector<std::string>& row : rows) {
    if (!row.empty() && !row.front().empty()) name = row.front();
    double x = 0.0;
    for (std::size_t k = 1; k < row.size(); ++k)
      if (io::read_number(row[k], x) && !std::isfinite(x)) return name;
  }
  return {};
}

}  // namespace

int kinematics_motion(const MotionArguments& arguments) {
  io::refuse_to_overwrite({arguments.file}, {arguments.json});
  io::MotionInput input;
  if (arguments.file.empty()) {
    if (!read_poses(arguments, input)) return exit_bad_input;
  } else {
    const io::MotionFile file = io::read_motion(arguments.file);
    print_problems(arguments.file, file.problems, file.warnings);
    if (!file.ok()) return exit_bad_input;
    input = file.input;
  }
  const motion::MotionReport report = io::describe(input);
  const std::vector<std::vector<std::string>> rows = io::motion_rows(report);
  if (const std::string name = first_not_finite(rows); !name.empty()) {
    std::cerr << "bough: " << name << " of this motion is not a finite number: it is too small, or too large, to be "
              << "described in double precision\n";
    return exit_failed;
  }
  write_to(arguments.json, io::motion_json(report));
  std::cout << table_text(rows);
  if (!arguments.json.empty()) std::cout << arguments.json.string() << "\n";
  return exit_done;
}

}  // namespace bough::app
