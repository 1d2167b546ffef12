/// Elastica at P L^2 / EI = 5 from thick to thin beams, against the boundary value problem with shear and extension.
#include <cmath>
#include <string>

#include "bench.hpp"
#include "bough/io/number_text.hpp"
#include "bough/scene/parts.hpp"
#include "planar_rod.hpp"

namespace bough::stress {

namespace {

constexpr double load = 5.0, shear_ratio = 5.0 / 6.0 / 2.6;  // square section, Poisson's ratio 0.3; L = EI = 1
constexpr int slenderness_count = 6;                         // L/h = 10 to 1e6

RodPiece rod_of(double slenderness) {
  const double EA = 12.0 * slenderness * slenderness;
  return {1.0, EA, shear_ratio * EA, 1.0, 0.0, 0.0};
}

/// Ten elements of order 3 reproduce the elastica to 1e-9. For a slender beam more elements are no better: shear and
/// extension are GA L^2 / EI times as stiff as bending, n elements in a row are n^2 times as flexible as one, and the
/// tangent's condition is about the product. At L/h = 1e6 it is 6e15 here. From 20 elements on it exceeds 1/u, bending
/// cannot be distinguished from free motion, and the run reports that the beam is unsupported.
scene::Scene cantilever(double slenderness) {
  const RodPiece r = rod_of(slenderness);
  scene::Scene s = scene::make_cantilever(scene::make_section("s", r.EA, r.GA, r.GA, 0.8, 1.0, 1.0), 1.0, 10, 3);
  s.point_loads = {scene::make_load("tip", {{0.0, load, 0.0}})};
  s.analysis.load_steps = 5;
  s.analysis.tolerance = 1e-11;
  return s;
}

std::string label(double slenderness) { return "L/h = " + io::rounded_text(slenderness, 1); }

void displacement(Bench& bench) {
  for (int k = 1; k <= slenderness_count; ++k) {
    const double slenderness = std::pow(10.0, k);
    const RodSection exact = cantilever_rod({rod_of(slenderness)}, 0.0, load).back();
    const run::MemoryRun run = bench.run(cantilever(slenderness), label(slenderness));
    bench.error("tip at " + label(slenderness), std::hypot(run.final("tip.x") - exact.x, run.final("tip.y") - exact.y),
                1e-8);
    // Elliptic integrals, without shear and extension: their effect is of order (h/L)^2, 1/12 in the strain times the
    // load.
    if (k == slenderness_count)
      bench.error("reference against the limit of no thickness", std::abs(exact.y - .713791523611912728), 1e-10);
  }
}

void section_forces(Bench& bench) {
  for (int k = 1; k <= slenderness_count; ++k) {
    const double slenderness = std::pow(10.0, k);
    RodPiece half = rod_of(slenderness);
    half.length = 0.5;
    const std::vector<RodSection> exact = cantilever_rod({half, half}, 0.0, load);
    scene::Scene s = cantilever(slenderness);
    s.sensors.push_back(scene::make_section_sensor("root", "beam", 0.0));
    s.sensors.push_back(scene::make_section_sensor("middle", "beam", 0.5));
    scene::Sensor strain = scene::make_section_sensor("strain", "beam", 0.5);
    strain.kind = scene::SensorKind::section_strain;
    s.sensors.push_back(strain);
    const run::MemoryRun run = bench.run(s, label(slenderness));
    double worst = 0.0;
    for (int i = 0; i < 2; ++i) {
      const std::string at = i == 0 ? "root" : "middle";
      const RodSection& e = exact[static_cast<std::size_t>(i)];
      worst = std::max({worst, std::abs(run.final(at + ".N") - e.normal_force()) / load,
                        std::abs(run.final(at + ".Q2") - e.shear_force()) / load,
                        std::abs(run.final(at + ".M3") - e.moment) / load});
    }
    bench.error("N, Q, M at " + label(slenderness), worst, 1e-8);
    bench.tell("N from the strain at " + label(slenderness),
               std::abs(rod_of(slenderness).EA * run.final("strain.e1") - exact[1].normal_force()) / load);
  }
}

}  // namespace

void add_slenderness(std::vector<Definition>& table) {
  table.push_back({"elastica", "slenderness",
                   "the tip of a cantilever under P L^2/EI = 5 is found to 1e-8 L for L/h from 10 to 1e6",
                   displacement});
  table.push_back({"section_forces", "slenderness",
                   "section forces, which strains would give to 2 log10(L/h) digits less, are found to 1e-8 P at the "
                   "same slendernesses, from the equilibrium of nodes",
                   section_forces});
}

}  // namespace bough::stress
