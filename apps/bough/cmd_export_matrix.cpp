/// bough export-matrix SCENE: the linear system of one step as Matrix Market files.
#include <iostream>

#include "arguments.hpp"
#include "bough/io/atomic_file.hpp"
#include "bough/io/manifest.hpp"
#include "bough/io/npy_history.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/study/linear_system.hpp"
#include "memory_limit.hpp"
#include "terminal.hpp"

namespace bough::app {

int export_matrix(const ExportMatrixArguments& arguments) {
  const io::SceneFile file = io::read_scene(arguments.scene, arguments.overrides);
  print_problems(arguments.scene, file, false);
  if (!file.ok()) return exit_bad_input;
  if (refuse_for_memory(arguments.scene, file.scene, arguments.memory_limit)) return exit_bad_input;
  const std::filesystem::path out =
      arguments.out.empty() ? std::filesystem::path(file.scene.name + ".mtx") : arguments.out;
  io::refuse_to_overwrite({arguments.scene}, {out, arguments.rhs});
  std::string cause;
  const auto system = study::make_linear_system(file.scene, {arguments.step, arguments.time},
                                                arguments.threads > 0 ? arguments.threads : default_threads(), cause,
                                                arguments.interface);
  if (!system) {
    std::cerr << "bough: " << file.scene.name << ": " << cause << "\n";
    return exit_failed;
  }
  const bool is_for_numpy = system->interface && out.extension() == ".npy";
  try {
    if (system->interface) {
      const study::InterfaceSystem& interface = *system->interface;
      const std::vector<double>& matrix = arguments.matrix == "S"   ? interface.stiffness
                                          : arguments.matrix == "P" ? interface.penalty
                                                                    : interface.flexibility;
      io::write_file(out, is_for_numpy
                              ? io::npy_square(matrix)
                              : io::matrix_market_text(matrix, interface.comments(arguments.matrix, system->step),
                                                       interface.unknowns.size()));
      std::cout << out.string() << ": " << arguments.matrix << " of interface " << arguments.interface << ", "
                << interface.unknowns.size() << " unknowns, condition " << io::rounded_text(interface.condition, 3)
                << ", step " << system->step << "\n";
      if (is_for_numpy) {
        std::cout << "unknowns:";
        for (const std::string& name : interface.unknowns) std::cout << " " << name << ";";
        std::cout << "\n";
      }
    } else {
      const std::vector<std::string> comments = system->comments(file.scene.name);
      io::write_file(out, io::matrix_market_text(system->matrix, comments));
      if (!arguments.rhs.empty()) io::write_file(arguments.rhs, io::matrix_market_text(system->rhs, comments));
      std::cout << out.string() << ": " << system->matrix.size << " unknowns, " << system->matrix.row.size()
                << " entries" << (system->matrix.is_symmetric ? " of the lower triangle, symmetric" : ", not symmetric")
                << ", step " << system->step << "\n";
    }
  } catch (const std::exception& error) {
    std::cerr << "bough: " << cause_of(error) << "\n";
    return exit_failed;
  }
  if (!system->trouble.empty()) std::cout << "bough does not solve it: " << system->trouble << "\n";
  return exit_done;
}

}  // namespace bough::app
