/// bough view DIR [OTHER]: the motion and the sensors of a run, or of two over each other, as one page.
#include <iostream>

#include "arguments.hpp"
#include "bough/io/atomic_file.hpp"
#include "bough/io/manifest.hpp"
#include "bough/io/run_store.hpp"
#include "bough/report/page.hpp"
#include "bough/report/raster.hpp"
#include "bough/study/collect.hpp"

namespace bough::app {

namespace {

/// A page in a folder of results belongs to it from then on: a later run into the folder takes it away with the rest.
void write_page(const std::filesystem::path& path, const std::string& text) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (io::read_manifest(folder))
    io::write_listed_file(folder, "view", path.filename().string(), text);
  else
    io::write_file(path, text);
}

/// Makes the folder of a case that is stored; false where it is not. Of shards that lie in the folder all are looked
/// at.
bool unpack_case(const std::filesystem::path& batch, const std::string& which) {
  std::vector<std::filesystem::path> places = {batch};
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(batch, ignored))
    if (std::filesystem::exists(entry.path() / study::shard_file, ignored)) places.push_back(entry.path());
  for (const std::filesystem::path& place : places) {
    std::vector<study::CaseResult> found;
    study::for_each_record(place / study::journal_file,
                           [&](const std::string&, const study::CaseResult& result, std::string_view) {
                             if (result.which.name == which && result.report.stored) found.push_back(result);
                           });
    for (; !found.empty(); found.pop_back()) {  // the last one first
      const auto files = io::read_stored(place, *found.back().report.stored);
      if (!files) continue;
      const study::CaseStatus status = found.back().status;
      const bool is_good = status == study::CaseStatus::ok || status == study::CaseStatus::figures_fail;
      (void)io::unpack_run(*files, is_good ? io::FolderState::good : io::FolderState::failed, batch / which);
      return true;
    }
  }
  return false;
}

}  // namespace

int view(const ViewArguments& given) {
  ViewArguments arguments = given;
  if (!given.which.empty()) {
    const std::filesystem::path batch = arguments.directory;
    arguments.directory /= std::filesystem::path(given.which).filename();
    if (!std::filesystem::exists(arguments.directory) && !unpack_case(batch, given.which)) {
      std::cerr << "bough: " << batch.string() << " holds no results of a case " << given.which
                << ": either it has no such case (" << (batch / study::journal_file).string()
                << " names them), or they were not kept, and bough sweep FILE --case " << given.which
                << " --out ANOTHER runs it again\n";
      return exit_bad_input;
    }
  }
  const std::filesystem::path page = arguments.out.empty() ? arguments.directory / "view.html" : arguments.out;
  std::vector<std::filesystem::path> inputs;
  for (const char* name :
       {"history.csv", "history.npy", "columns.json", "motion.bin", "motion.pvd", "summary.json", io::manifest_name}) {
    inputs.push_back(arguments.directory / name);
    if (!arguments.other.empty()) inputs.push_back(arguments.other / name);
  }
  io::refuse_to_overwrite(inputs, {page, arguments.svg, arguments.png});
  report::RunFiles files, other;
  try {
    files = report::read_run(arguments.directory);
    if (!arguments.other.empty()) other = report::read_run(arguments.other);
  } catch (const std::exception& error) {
    std::cerr << "bough: " << error.what() << "\n";
    return exit_bad_input;
  }
  if (files.motion.empty()) std::cerr << "bough: " << report::how_to_record_motion() << "\n";
  if (files.motion.empty() && !(arguments.svg.empty() && arguments.png.empty())) return exit_bad_input;

  report::PictureOptions options;
  options.view = report::view_named(arguments.view).value_or(report::View::automatic);
  options.is_static = report::is_static(files);
  options.num_positions = arguments.positions > 0 ? arguments.positions : 3;
  write_page(page, report::page_html(files, options, arguments.other.empty() ? nullptr : &other));
  std::cout << page.string() << "\n";
  if (!arguments.svg.empty()) {
    options.num_positions = arguments.positions > 0 ? arguments.positions : 9;
    write_page(arguments.svg, report::standalone_svg(report::make_picture(files.motion, options), files.name));
    std::cout << arguments.svg.string() << "\n";
  }
  if (!arguments.png.empty()) {
    report::RasterOptions raster;
    raster.view = options.view;
    write_page(arguments.png, report::picture_png(files, arguments.time.value_or(files.motion.back().time), raster));
    std::cout << arguments.png.string() << "\n";
  }
  return exit_done;
}

}  // namespace bough::app
