/// bough view DIR [OTHER]: the motion and the sensors of a run, or of two over each other, as one page.
#include <iostream>

#include "arguments.hpp"
#include "bough/io/atomic_file.hpp"
#include "bough/io/manifest.hpp"
#include "bough/io/run_store.hpp"
#include "bough/io/unfinished_run.hpp"
#include "bough/report/page.hpp"
#include "bough/report/raster.hpp"
#include "bough/study/case_folders.hpp"
#include "bough/study/collect.hpp"

namespace bough::app {

namespace {

/// A page in a folder of results belongs to it from then on: a later run into the folder takes it away with the rest.
void write_page(const std::filesystem::path& path, const std::string& text) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (io::read_manifest(folder))
    io::write_listed_file(folder, {"view"}, path.filename().string(), text);
  else
    io::write_file(path, text);
}

/// The folder of a case, which is made of its stored results where it has none. Throws std::runtime_error where there
/// are no results of it.
std::filesystem::path folder_of_case(const std::filesystem::path& batch, const std::string& which) {
  const std::optional<study::FoundCase> found = study::find_case(batch, which);
  if (!found)
    throw std::runtime_error(batch.string() + " has no case " + which + ": " + (batch / study::keys_file).string() +
                             " names those that it has");
  std::filesystem::path folder = found->batch / std::filesystem::path(which).filename();
  const std::optional<io::Manifest> there = io::read_manifest(folder);
  const bool is_of_case = there && there->key == found->key;
  if (is_of_case && (!found->result || study::holds_case(folder, found->key, *found->result))) return folder;
  if (found->result && found->result->report.stored)
    if (const auto files = io::read_stored(found->batch, *found->result->report.stored, found->key)) {
      const study::CaseStatus status = found->result->status;
      const bool is_good = status == study::CaseStatus::ok || status == study::CaseStatus::figures_fail;
      (void)study::remove_case(folder);
      return io::unpack_run(*files, is_good ? io::FolderState::good : io::FolderState::failed, folder,
                            {.verb = "run", .key = found->key});
    }
  if (there && !is_of_case) throw std::runtime_error(study::why_not_of_its_case(folder));
  throw std::runtime_error(batch.string() + " holds no results of the case " + which +
                           ": they were not kept, and bough sweep FILE --case " + which +
                           " --out ANOTHER runs it again");
}

}  // namespace

int view(const ViewArguments& given) {
  ViewArguments arguments = given;
  try {
    if (!given.which.empty()) arguments.directory = folder_of_case(given.directory, given.which);
    for (const std::filesystem::path& folder : {arguments.directory, arguments.other})
      if (const std::string why = folder.empty() ? "" : study::why_not_of_its_case(folder); !why.empty())
        throw std::runtime_error(why);
  } catch (const std::runtime_error& error) {
    std::cerr << "bough: " << error.what() << "\n";
    return exit_bad_input;
  }
  const std::optional<io::UnfinishedRun> unfinished = io::find_unfinished_run(arguments.directory);
  if (unfinished)
    std::cerr << "bough: " << arguments.directory.string()
              << (unfinished->goes_on ? " is being written: the page shows what is there of it now\n"
                                      : " is of a run that did not end: the page shows what is there of it\n");
  // The folder of a run that goes on is its writer's.
  const bool has_own_folder = !unfinished || unfinished->place == arguments.directory;
  std::filesystem::path page = has_own_folder ? arguments.directory / "view.html" : arguments.directory;
  if (!has_own_folder) page += ".html";
  if (!arguments.out.empty()) page = arguments.out;
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
    const bool is_of_modes = report::is_of_modes(files);
    const int mode = 1 + static_cast<int>(arguments.time.value_or(0.0));
    write_page(arguments.svg,
               report::standalone_svg(
                   report::make_picture(is_of_modes ? report::frames_of_mode(files, mode) : files.motion, options),
                   files.name));
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
