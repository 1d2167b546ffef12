#pragma once
#include <string>
#include <vector>

#include "bough/scene/scene.hpp"

namespace bough::run {

/// A twin of a run: a scene that differs from it in the step size or in the numbers of elements alone.
struct Twin {
  scene::Scene scene;
  bool is_of_mesh = false;
  double factor = 1.0;  ///< of the step size (in statics of the number of load steps), or of the numbers of elements
  double cost = 1.0;    ///< estimated, over that of the run
};

/// The errors that a scene wants measured and has: without beams there is none of the mesh, in inverse dynamics none in
/// time.
scene::ErrorsWanted errors_of(const scene::Scene& scene);

/// "steps 2 times as long", "0.5 times as many elements".
std::string text_of(const Twin& twin);

/// The same scene with the numbers of elements of all beams, or of one, times a factor; inner nodes that it names stay
/// where they are.
scene::Scene with_elements(const scene::Scene& scene, double factor, const std::string& beam = {});

struct Twins {
  std::vector<Twin> members;
  std::vector<std::string> remarks;  ///< why there are none of a kind, in words
};

/// Twins of a scene as its analysis wants them. In dynamics: steps of twice and four times the size. In statics: twice as
/// many load steps. Of the mesh: all numbers of elements times one factor, so that inner nodes "<beam>.<k>" which the
/// scene names stay where they are: a half and a quarter; a half and two; or two and four where the numbers, or those of
/// named inner nodes, are odd. Twins are not recorded and not checked. Precondition: problems_in(scene) is empty.
Twins make_twins(const scene::Scene& scene);

/// A twin in time with steps of `factor` times the size.
Twin twin_in_time(const scene::Scene& scene, double factor);

/// For each beam a twin in which it alone has twice as many elements.
std::vector<Twin> twins_of_beams(const scene::Scene& scene);

}  // namespace bough::run
