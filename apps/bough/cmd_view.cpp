/// bough view DIR: the motion and the sensors of a run as one page.
#include <iostream>

#include "arguments.hpp"
#include "bough/io/atomic_file.hpp"
#include "bough/report/page.hpp"

namespace bough::app {

int view(const ViewArguments& arguments) {
  report::RunFiles files;
  try {
    files = report::read_run(arguments.directory);
  } catch (const std::exception& error) {
    std::cerr << "bough: " << error.what() << "\n";
    return exit_bad_input;
  }
  if (files.motion.empty()) std::cerr << "bough: " << report::how_to_record_motion() << "\n";
  if (files.motion.empty() && !arguments.svg.empty()) return exit_bad_input;

  report::PictureOptions options;
  options.view = report::view_named(arguments.view).value_or(report::View::automatic);
  options.num_positions = arguments.positions;
  options.is_static = report::is_static(files);
  const std::filesystem::path page = arguments.out.empty() ? arguments.directory / "view.html" : arguments.out;
  io::write_file(page, report::page_html(files, options));
  std::cout << page.string() << "\n";
  if (!arguments.svg.empty()) {
    io::write_file(arguments.svg, report::standalone_svg(report::make_picture(files.motion, options), files.name));
    std::cout << arguments.svg.string() << "\n";
  }
  return exit_done;
}

}  // namespace bough::app
