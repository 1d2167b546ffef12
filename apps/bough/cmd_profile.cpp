/// bough profile SCENE: the tree of sub-domains as it is and as it runs.
#include <filesystem>
#include <iostream>

#include "arguments.hpp"
#include "bough/io/output_folder.hpp"
#include "bough/io/profile_json.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/records/no_recorder.hpp"
#include "bough/study/profile.hpp"
#include "bough/version.hpp"
#include "memory_limit.hpp"
#include "pages.hpp"
#include "standard_streams.hpp"
#include "terminal.hpp"
#include "tree_text.hpp"

namespace bough::app {

int profile(const ProfileArguments& arguments) {
  const io::SceneFile file = io::read_scene(arguments.scene, arguments.overrides);
  print_problems(arguments.scene, file, arguments.quiet);
  if (!file.ok()) return exit_bad_input;
  if (refuse_for_memory(arguments.scene, file.scene, arguments.memory_limit)) return exit_bad_input;
  const std::filesystem::path out =
      arguments.out.empty() ? std::filesystem::path(file.scene.name + ".profile") : arguments.out;
  const io::Owner owner{.verb = "profile", .source = arguments.scene, .replaces = arguments.replace};
  io::OutputFolder folder(out, owner, {"profile.json", "trace.json", "profile.html"}, {arguments.scene});
  catch_interrupts();
  ProgressBar bar(arguments.quiet);
  study::ProfileOptions options;
  options.threads = arguments.threads > 0 ? arguments.threads : default_threads();
  options.steps = arguments.steps;
  records::NoRecorder nobody;
  records::Profile result;
  std::string pages;
  try {
    result = study::profile(file.scene, options, nobody, [&bar](const records::Progress& progress) {
      bar.show(progress);
      return !interrupted();
    });
    bar.clear();
    folder.write("profile.json", io::profile_text(result, version));
    folder.write("trace.json", io::trace_text(result));
    pages = write_profile_page(folder, "profile.html", result, "profile.json");
    folder.publish(result.trouble.empty() ? io::FolderState::good : io::FolderState::failed);
  } catch (const std::exception& error) {
    bar.clear();
    std::cerr << "bough: " << cause_of(error) << "\n";
    return exit_failed;
  }
  tell_if_beside(folder);
  if (!arguments.quiet) write_to_terminal(false, tree_text(result, style_of_terminal()));
  if (!arguments.quiet)
    std::cout << "Profile in " << folder.folder().string() << ": " << pages << "profile.json trace.json\n"
              << std::flush;
  if (result.trouble.empty()) return exit_done;
  std::cerr << "bough: " << file.scene.name << ": " << result.trouble << "\n";
  return exit_failed;
}

}  // namespace bough::app
