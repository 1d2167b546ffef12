#include <cstdint>
#include <cstring>

#include "bough/io/atomic_file.hpp"
#include "bough/io/motion_frames.hpp"
#include "bough/io/write_vtu.hpp"
#include "write_samples.hpp"

namespace bough::io {
namespace {

/// The raw block of the array `name`: its bytes, found through the offset that the XML part states.
std::string block_of(const std::string& vtu, const std::string& name) {
  const std::size_t array = vtu.find("Name=\"" + name + "\"");
  const std::size_t offset_at = vtu.find("offset=\"", array) + 8;
  const std::size_t data = vtu.find("<AppendedData encoding=\"raw\">");
  const std::size_t start = vtu.find('_', data) + 1 + std::stoul(vtu.substr(offset_at));
  std::uint64_t size = 0;
  std::memcpy(&size, vtu.data() + start, sizeof size);
  return vtu.substr(start + sizeof size, size);
}

template <class T>
std::vector<T> values_of(const std::string& vtu, const std::string& name) {
  const std::string block = block_of(vtu, name);
  std::vector<T> values(block.size() / sizeof(T));
  std::memcpy(values.data(), block.data(), block.size());
  return values;
}

TEST(Vtu, arrays_stand_where_their_offsets_say_and_agree_in_length) {
  const results::MotionFrame frame = sample_frame(0.7);
  const std::string vtu = vtu_text(frame, vtu_options_for(frame));
  const auto points = values_of<double>(vtu, "Points");
  const auto offsets = values_of<std::int64_t>(vtu, "offsets");
  const auto connectivity = values_of<std::int64_t>(vtu, "connectivity");
  const auto types = values_of<std::uint8_t>(vtu, "types");
  const std::size_t num_points = 5 * 5 + 8 + 2, num_cells = 1 + 4 + 1 + 1;
  EXPECT_EQ(points.size(), 3 * num_points);
  EXPECT_EQ(types.size(), num_cells);
  ASSERT_EQ(offsets.size(), num_cells);
  EXPECT_EQ(offsets.back(), static_cast<std::int64_t>(connectivity.size()));
  for (const std::int64_t index : connectivity) EXPECT_LT(index, static_cast<std::int64_t>(num_points));
  for (const char* name : {"force", "moment", "axis_1", "axis_2", "axis_3"})
    EXPECT_EQ(values_of<double>(vtu, name).size(), 3 * num_points) << name;
  for (const char* name : {"kind", "part"}) EXPECT_EQ(values_of<std::int32_t>(vtu, name).size(), num_cells) << name;
  EXPECT_NE(vtu.find("NumberOfPoints=\"35\" NumberOfCells=\"7\""), std::string::npos);
  EXPECT_TRUE(vtu.ends_with("\n  </AppendedData>\n</VTKFile>\n")) << "nothing after the last block but the end";
}

TEST(Vtu, hexahedra_of_a_swept_beam_have_positive_volume) {
  const results::MotionFrame frame = sample_frame(1.0);
  const VtuOptions options = vtu_options_for(frame);
  const std::string vtu = vtu_text(frame, options);
  const auto x = values_of<double>(vtu, "Points");
  const auto corners = values_of<std::int64_t>(vtu, "connectivity");
  const auto offsets = values_of<std::int64_t>(vtu, "offsets");
  const auto types = values_of<std::uint8_t>(vtu, "types");
  int num_hexahedra = 0;
  for (std::size_t c = 0; c < types.size(); ++c) {
    if (types[c] != 12) continue;
    ++num_hexahedra;
    const auto corner = [&](std::size_t k) {
      return &x[3 * static_cast<std::size_t>(corners[static_cast<std::size_t>(offsets[c]) - 8 + k])];
    };
    double edge[3][3];
    for (int k = 0; k < 3; ++k) {
      edge[0][k] = corner(1)[k] - corner(0)[k];
      edge[1][k] = corner(3)[k] - corner(0)[k];
      edge[2][k] = corner(4)[k] - corner(0)[k];
    }
    const double volume = edge[0][0] * (edge[1][1] * edge[2][2] - edge[1][2] * edge[2][1]) -
                          edge[0][1] * (edge[1][0] * edge[2][2] - edge[1][2] * edge[2][0]) +
                          edge[0][2] * (edge[1][0] * edge[2][1] - edge[1][1] * edge[2][0]);
    EXPECT_GT(volume, 0.0);
  }
  EXPECT_EQ(num_hexahedra, 5);
}

TEST(Vtu, a_frame_without_parts_is_an_empty_grid) {
  const std::string vtu = vtu_text({}, vtu_options_for({}));
  EXPECT_NE(vtu.find("NumberOfPoints=\"0\" NumberOfCells=\"0\""), std::string::npos);
}

TEST(MotionLines, frames_come_back_to_nine_digits) {
  const ScratchDirectory scratch;
  MotionLinesWriter writer(scratch / "motion.jsonl");
  for (int k = 0; k < 4; ++k) writer.frame(sample_frame(0.25 * k));
  writer.commit();
  const std::vector<results::MotionFrame> frames = read_motion_lines(scratch / "motion.jsonl", 100);
  ASSERT_EQ(frames.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    const results::MotionFrame expected = sample_frame(0.25 * static_cast<double>(k));
    EXPECT_EQ(frames[k].time, expected.time);
    EXPECT_EQ(frames[k].curves.at(0).name, "beam");
    EXPECT_EQ(frames[k].bodies.at(0).name, "crank");
    EXPECT_EQ(frames[k].links.at(0).name, "hinge");
    EXPECT_EQ(frames[k].bodies.at(0).center[0], 0.1);
    EXPECT_EQ(frames[k].bodies.at(0).attachments, expected.bodies[0].attachments);
    for (std::size_t p = 0; p < 5; ++p)
      for (int c = 0; c < 3; ++c)  // half a unit of the ninth digit, coordinates below 1
        EXPECT_NEAR(frames[k].curves.at(0).points.at(p).position[c], expected.curves[0].points[p].position[c], 5e-10);
  }
}

TEST(MotionLines, a_selection_is_even_and_holds_first_and_last) {
  const ScratchDirectory scratch;
  MotionLinesWriter writer(scratch / "motion.jsonl");
  for (int k = 0; k <= 100; ++k) writer.frame(sample_frame(k));
  writer.commit();
  for (const std::size_t wanted : {2u, 3u, 7u, 50u, 101u, 500u}) {
    const auto frames = read_motion_lines(scratch / "motion.jsonl", wanted);
    const std::size_t expected = std::min<std::size_t>(wanted, 101);
    ASSERT_EQ(frames.size(), expected);
    EXPECT_EQ(frames.front().time, 0.0);
    EXPECT_EQ(frames.back().time, 100.0);
    for (std::size_t k = 1; k < frames.size(); ++k)
      EXPECT_NEAR(frames[k].time - frames[k - 1].time, 100.0 / static_cast<double>(expected - 1), 1.0);
  }
}

TEST(MotionLines, damaged_files_are_refused_with_their_line) {
  const ScratchDirectory scratch;
  const std::string head = R"({"format":"bough motion 1","curves":["a"],"bodies":[],"links":[]})";
  const std::pair<std::string, const char*> cases[] = {
      {"", "holds no frame"},
      {head + "\n", "holds no frame"},
      {"{\"format\":\"other\"}\n{}\n", ":1: not a file of the format"},
      {head + "\n{\"t\":0}\n", ":2: not a frame"},
      {head + "\n{\"t\":0,\"c\":[[1,2]]}\n", ":2: not a frame"},
      {head + "\n{\"t\":0,\"c\":[[1,2,\"x\"]]}\n", ":2: not a frame"},
      {head + "\n{\"t\":0,\"c\":[[1,2,3]]}\n{\"t\":1,\n", ":3: not a JSON object"},
  };
  for (const auto& [text, message] : cases) {
    write_file(scratch / "m.jsonl", text);
    try {
      (void)read_motion_lines(scratch / "m.jsonl", 10);
      ADD_FAILURE() << "accepted: " << text;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  }
}

TEST(Pvd, lists_the_frames_with_their_times) {
  const std::string pvd = pvd_text({{0.0, "motion/frame_000000.vtu"}, {0.1, "a&b\".vtu"}});
  EXPECT_NE(pvd.find("timestep=\"0.1\" group=\"\" part=\"0\" file=\"a&amp;b&quot;.vtu\""), std::string::npos) << pvd;
}

}  // namespace
}  // namespace bough::io
