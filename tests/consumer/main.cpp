// A user of the installed package: reads a scene, drives its simulation, and counts what
// it is given.
//   consumer SOURCE_TREE
#include <cstdio>
#include <string>
#include <vector>

#include "bough/io/read_scene.hpp"
#include "bough/records/run.hpp"
#include "bough/run/simulation.hpp"
#include "bough/version.hpp"

namespace {

struct CountRows : bough::records::Recorder {
  long rows = 0;
  void begin(const bough::records::HistoryHeader&) override {}
  void row(const bough::records::HistoryRow&) override { ++rows; }
  void motion(const bough::records::MotionFrame&) override {}
  void end(const bough::records::Summary&) override {}
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 || bough::version != EXPECTED_VERSION) {
    std::printf("one argument, and version %s\n", EXPECTED_VERSION);
    return 1;
  }
  const std::vector<std::string> overrides = {"/analysis/end_time=1.5", "/expected=[]"};
  const bough::io::SceneFile file =
      bough::io::read_scene(std::string(argv[1]) + "/data/scenarios/pendulum.json", overrides);
  for (const bough::io::Problem& problem : file.problems) {
    std::printf("%s\n", problem.text().c_str());
  }
  if (!file.ok()) {
    return 1;
  }
  CountRows recorder;
  bough::run::Simulation simulation(file.scene, {.threads = 2}, &recorder);
  const bool is_half_way = simulation.advance_to(0.75);
  const std::string sensor = simulation.header().columns.front();
  const double half_way = simulation.value(sensor);
  const auto moment = simulation.save();
  const bool is_done = simulation.run();
  simulation.restore(*moment);
  const bool is_back = simulation.value(sensor) == half_way && simulation.run();
  const bough::records::Summary& summary = simulation.finish();
  std::printf("bough %s: %ld rows, %s\n", EXPECTED_VERSION, recorder.rows, summary.cause.c_str());
  return is_half_way && is_done && is_back && summary.status == bough::records::RunStatus::ok && recorder.rows > 100
             ? 0
             : 1;
}
