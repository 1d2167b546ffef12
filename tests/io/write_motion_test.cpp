#include <zlib.h>

#include <cstdint>
#include <cstring>

#include "bough/io/atomic_file.hpp"
#include "bough/io/motion_frames.hpp"
#include "bough/io/write_vtu.hpp"
#include "bough/scene/outlines.hpp"
#include "write_samples.hpp"

namespace bough::io {
namespace {

/// The array `name`: its compressed blocks, found through the offset that the XML part states.
std::string block_of(const std::string& vtu, const std::string& name) {
  const std::size_t array = vtu.find("Name=\"" + name + "\"");
  const std::size_t offset_at = vtu.find("offset=\"", array) + 8;
  const std::size_t data = vtu.find("<AppendedData encoding=\"raw\">");
  std::size_t at = vtu.find('_', data) + 1 + std::stoul(vtu.substr(offset_at));
  const auto next = [&] {
    std::uint64_t value = 0;
    std::memcpy(&value, vtu.data() + at, sizeof value);
    at += sizeof value;
    return value;
  };
  const std::uint64_t count = next(), size = next(), last = next();
  std::vector<std::uint64_t> packed;
  for (std::uint64_t b = 0; b < count; ++b) packed.push_back(next());
  std::string bytes;
  for (std::uint64_t b = 0; b < count; ++b) {
    uLongf length = static_cast<uLongf>(b + 1 == count && last > 0 ? last : size);
    std::string part(length, '\0');
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(part.data()), &length,
                         reinterpret_cast<const Bytef*>(vtu.data() + at), static_cast<uLong>(packed[b])),
              Z_OK);
    bytes += part;
    at += packed[b];
  }
  return bytes;
}

template <class T>
std::vector<T> values_of(const std::string& vtu, const std::string& name) {
  const std::string block = block_of(vtu, name);
  std::vector<T> values(block.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), block.data(), block.size());
  return values;
}

/// The sample's beam as an I with a hole beside it in its outline, its body as a cuboid.
records::MotionParts sample_parts() {
  records::MotionParts parts;
  parts.outlines = {{{{{-0.02, -0.03}, {0.02, -0.03}, {0.02, 0.03}, {-0.02, 0.03}},
                      {{-0.01, -0.01}, {-0.01, 0.01}, {0.01, 0.01}, {0.01, -0.01}}}}};
  parts.meshes = {scene::mesh_of(scene::Box{{{0.1, 0.2, 0.3}}})};
  parts.curves = {{0, {3, 3, 4, 4}}};
  parts.bodies = {0};
  parts.links = {{"revolute"}};
  return parts;
}

TEST(Vtu, arrays_stand_where_their_offsets_say_and_agree_in_length) {
  const std::string vtu = vtu_text(sample_frame(0.7), sample_parts());
  const auto points = values_of<float>(vtu, "Points");
  const auto offsets = values_of<std::int32_t>(vtu, "offsets");
  const auto connectivity = values_of<std::int32_t>(vtu, "connectivity");
  const auto types = values_of<std::uint8_t>(vtu, "types");
  const std::size_t num_points = points.size() / 3, num_cells = types.size();
  EXPECT_EQ(num_points, 5u + 5u * 8u + 10u + 2u);       // axis, corners of sections, body (8 and 2 middles), link
  EXPECT_EQ(num_cells, 1u + 4u * 8u + (8u + 8u) + 1u);  // a ring of 8 corners has 8 triangles
  ASSERT_EQ(offsets.size(), num_cells);
  EXPECT_EQ(offsets.back(), static_cast<std::int32_t>(connectivity.size()));
  for (const std::int32_t index : connectivity) EXPECT_LT(index, static_cast<std::int32_t>(num_points));
  for (const char* name : {"force", "moment", "strain", "curvature", "velocity", "axis_1", "axis_2", "axis_3"})
    EXPECT_EQ(values_of<float>(vtu, name).size(), 3 * num_points) << name;
  for (const char* name : {"kind", "part", "subdomain"})
    EXPECT_EQ(values_of<std::int32_t>(vtu, name).size(), num_cells) << name;
  EXPECT_NE(vtu.find("Name=\"beam_names\" NumberOfTuples=\"1\" format=\"ascii\">\n98 101 97 109 0\n"),
            std::string::npos);
  EXPECT_TRUE(vtu.ends_with("\n  </AppendedData>\n</VTKFile>\n")) << "nothing after the last block but the end";
}

// The sample's resultants are (1, 2, 3) N and (4, 5, 6) N m in all sections.
TEST(Vtu, forces_and_moments_are_those_of_the_sections) {
  const std::string vtu = vtu_text(sample_frame(0.7), sample_parts());
  const auto force = values_of<float>(vtu, "force"), moment = values_of<float>(vtu, "moment");
  const std::size_t of_sections = 5u + 5u * 8u;  // points of the axis, corners of sections
  ASSERT_GE(force.size(), 3 * of_sections);
  for (std::size_t k = 0; k < of_sections; ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(force[3 * k + i], 1.0f + static_cast<float>(i)) << k;
      EXPECT_EQ(moment[3 * k + i], 4.0f + static_cast<float>(i)) << k;
    }
}

TEST(Vtu, wedges_and_surfaces_enclose_the_volumes_of_section_and_body) {
  records::MotionFrame frame = sample_frame(0.0);  // straight, 1 m long
  const records::MotionParts parts = sample_parts();
  const std::string vtu = vtu_text(frame, parts);
  const auto x = values_of<float>(vtu, "Points");
  const auto corners = values_of<std::int32_t>(vtu, "connectivity");
  const auto offsets = values_of<std::int32_t>(vtu, "offsets");
  const auto types = values_of<std::uint8_t>(vtu, "types");
  double beam = 0.0, body = 0.0;
  const auto six_volumes = [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    const auto at = [&](std::int32_t p, std::size_t c) {
      return static_cast<double>(x[3 * static_cast<std::size_t>(p) + c]);
    };
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c)
      sum += at(i, c) * (at(j, (c + 1) % 3) * at(k, (c + 2) % 3) - at(j, (c + 2) % 3) * at(k, (c + 1) % 3));
    return sum;
  };
  for (std::size_t c = 0; c < types.size(); ++c) {
    const auto n = static_cast<std::size_t>(types[c] == 13 ? 6 : types[c] == 5 ? 3 : 0);
    const std::int32_t* p = corners.data() + static_cast<std::size_t>(offsets[c]) - n;
    if (n == 3) body += six_volumes(p[0], p[1], p[2]) / 6.0;
    if (n != 6) continue;
    // Faces as VTK orders them, each seen counter-clockwise from outside.
    double six = six_volumes(p[0], p[1], p[2]) + six_volumes(p[3], p[5], p[4]);
    for (const auto& [a, b, d, e] : {std::array{0, 3, 4, 1}, std::array{1, 4, 5, 2}, std::array{2, 5, 3, 0}})
      six += six_volumes(p[a], p[b], p[d]) + six_volumes(p[a], p[d], p[e]);
    EXPECT_GT(six, 0.0);
    beam += six / 6.0;
  }
  EXPECT_NEAR(beam, 0.04 * 0.06 - 0.02 * 0.02, 1e-9);
  EXPECT_NEAR(body, 0.1 * 0.2 * 0.3, 1e-9);
}

TEST(Vtu, far_from_the_origin_points_are_in_double_precision) {
  records::MotionFrame frame = sample_frame(0.0);
  EXPECT_NE(vtu_text(frame).find("type=\"Float32\" Name=\"Points\""), std::string::npos);
  for (records::CurvePoint& p : frame.curves[0].points) p.position[0] += 1e7;
  frame.bodies.clear();
  frame.links.clear();
  EXPECT_NE(vtu_text(frame).find("type=\"Float64\" Name=\"Points\""), std::string::npos);
}

TEST(Vtu, signals_are_data_of_the_field) {
  records::MotionFrame frame;
  frame.signals = {{"command", 0.25}};
  EXPECT_NE(vtu_text(frame).find("Name=\"signal command\" NumberOfTuples=\"1\" format=\"ascii\">0.25</DataArray>"),
            std::string::npos);
}

TEST(Vtu, a_frame_without_parts_is_an_empty_grid) {
  EXPECT_NE(vtu_text({}).find("NumberOfPoints=\"0\" NumberOfCells=\"0\""), std::string::npos);
}

TEST(MotionFile, frames_come_back_to_single_precision_of_their_displacements) {
  const ScratchDirectory scratch;
  records::MotionParts parts;
  parts.outlines = {{{{{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}}}}};
  parts.meshes = {{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}};
  parts.curves = {{0, {3, 1, 4, 1}}};
  parts.bodies = {0};
  parts.links = {{"revolute"}};
  parts.signal_units = {"N m", ""};
  MotionWriter writer(scratch / "motion.bin", parts);
  const double far = 1e6;  // where a displacement of a micrometre would be lost in single precision
  const auto moved = [&](int k) {
    records::MotionFrame f = sample_frame(0.25 * k);
    for (records::CurvePoint& p : f.curves[0].points) p.position[0] += far;
    f.signals = {{"command", 0.5 * k}, {"valve", -1.25}};
    f.turn = 0.125 * k;
    const double v = 2.0 + k;
    f.curves[0].points[2].velocity[1] = v;
    f.bodies[0].velocity[2] = 2.0 * v;
    f.links[0].first_velocity[0] = 3.0 * v;
    f.links[0].second_velocity[1] = 4.0 * v;
    f.frames.push_back({"cart", {0.0, 0.0, 0.0}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {5.0 * v, 0.0, 0.0}});
    f.arrows.push_back({"push", {0.0, 0.0, 0.0}, {7.0, 0.0, 0.0}, {0.0, 8.0, 0.0}, false, {0.0, 0.0, 6.0 * v}});
    return f;
  };
  for (int k = 0; k < 4; ++k) writer.frame(moved(k));
  writer.commit();
  const Motion motion = read_motion_file(scratch / "motion.bin", 100);
  EXPECT_EQ(motion.num_recorded, 4u);
  ASSERT_EQ(motion.frames.size(), 4u);
  EXPECT_EQ(motion.parts.curves.at(0).subdomains, parts.curves[0].subdomains);
  EXPECT_EQ(motion.parts.links.at(0).kind, "revolute");
  EXPECT_EQ(motion.parts.signal_units, parts.signal_units);
  EXPECT_EQ(motion.parts.outlines.at(0).loops, parts.outlines[0].loops);
  EXPECT_EQ(motion.parts.meshes.at(0).points, parts.meshes[0].points);
  EXPECT_EQ(motion.parts.meshes.at(0).triangles, parts.meshes[0].triangles);
  for (std::size_t k = 0; k < 4; ++k) {
    const records::MotionFrame expected = moved(static_cast<int>(k)), &got = motion.frames[k];
    EXPECT_EQ(got.time, expected.time);
    EXPECT_EQ(got.turn, expected.turn);
    const double v = 2.0 + static_cast<double>(k);
    EXPECT_EQ(got.curves.at(0).points.at(2).velocity[1], v);
    EXPECT_EQ(got.bodies.at(0).velocity[2], 2.0 * v);
    EXPECT_EQ(got.links.at(0).first_velocity[0], 3.0 * v);
    EXPECT_EQ(got.links.at(0).second_velocity[1], 4.0 * v);
    EXPECT_EQ(got.frames.at(0).velocity[0], 5.0 * v);
    EXPECT_EQ(got.arrows.at(0).velocity[2], 6.0 * v);
    EXPECT_EQ(got.arrows.at(0).force[0], 7.0);
    EXPECT_EQ(got.curves.at(0).name, "beam");
    EXPECT_EQ(got.bodies.at(0).name, "crank");
    EXPECT_EQ(got.links.at(0).name, "hinge");
    ASSERT_EQ(got.signals.size(), 2u);
    EXPECT_EQ(got.signals[0].name, "command");
    EXPECT_EQ(got.signals[0].value, 0.5 * static_cast<double>(k));
    EXPECT_EQ(got.signals[1].value, -1.25);
    EXPECT_EQ(got.bodies.at(0).center[0], 0.1);
    EXPECT_EQ(got.bodies.at(0).attachments, expected.bodies[0].attachments);
    for (std::size_t p = 0; p < 5; ++p) {
      const records::CurvePoint &a = got.curves.at(0).points.at(p), &b = expected.curves[0].points[p];
      for (int c = 0; c < 3; ++c)  // displacements below 0.1 in 24 bits, and one unit of the last place of 1e6
        EXPECT_NEAR(a.position[c], b.position[c], 4e-9 + 2e-10);
      for (int c = 0; c < 9; ++c) EXPECT_NEAR(a.axes[c], b.axes[c], 1e-7);
      for (int c = 0; c < 6; ++c) EXPECT_EQ(a.force[c], b.force[c]);
    }
  }
}

TEST(MotionFile, a_selection_is_even_and_holds_first_and_last) {
  const ScratchDirectory scratch;
  MotionWriter writer(scratch / "motion.bin");
  for (int k = 0; k <= 100; ++k) writer.frame(sample_frame(k));
  writer.commit();
  for (const std::size_t wanted : {2u, 3u, 7u, 50u, 101u, 500u}) {
    const auto frames = read_motion_file(scratch / "motion.bin", wanted).frames;
    const std::size_t expected = std::min<std::size_t>(wanted, 101);
    ASSERT_EQ(frames.size(), expected);
    EXPECT_EQ(frames.front().time, 0.0);
    EXPECT_EQ(frames.back().time, 100.0);
    for (std::size_t k = 1; k < frames.size(); ++k)
      EXPECT_NEAR(frames[k].time - frames[k - 1].time, 100.0 / static_cast<double>(expected - 1), 1.0);
  }
}

TEST(MotionFile, of_what_turns_as_many_frames_are_read_as_its_turns_need) {
  const ScratchDirectory scratch;
  MotionWriter writer(scratch / "motion.bin");
  for (int k = 0; k <= 400; ++k) {
    records::MotionFrame f = sample_frame(k);
    f.turn = k == 0 ? 0.0 : 0.25;
    writer.frame(f);
  }
  writer.commit();
  const auto frames = read_motion_file(scratch / "motion.bin", 10).frames;
  double sum = 0.0;
  for (const records::MotionFrame& f : frames) {
    EXPECT_LE(f.turn, records::largest_turn);
    sum += f.turn;
  }
  EXPECT_EQ(sum, 100.0) << "turns of frames that are left out count for the next one";
  EXPECT_EQ(frames.back().time, 400.0);
  EXPECT_LT(frames.size(), 401u);
}

TEST(MotionFile, damaged_files_are_refused_in_words_and_frames_cut_off_do_not_count) {
  const ScratchDirectory scratch;
  MotionWriter writer(scratch / "motion.bin");
  for (int k = 0; k < 3; ++k) writer.frame(sample_frame(k));
  writer.commit();
  const std::string good = text_of(scratch / "motion.bin");
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    return text.replace(text.find(from), from.size(), to);
  };
  const std::string head = good.substr(0, good.find('\n') + 1);
  const std::pair<std::string, const char*> cases[] = {
      {"", "not a file of the format"},
      {"{}\n", "not a file of the format"},
      {"{\"format\":\"bough motion 1\"}\n", "not a file of the format"},
      {head, "holds no frame"},
      {good.substr(0, head.size() + 20), "holds no frame"},
      {changed("\"points\":5", "\"points\":6"), "does not say what the frames hold"},
      {changed("\"points\":5", "\"points\":-5"), "does not say what the frames hold"},
      {changed("\"points\":5", "\"points\":\"\""), "does not say what the frames hold"},
      {changed("\"mesh\":-1", "\"mesh\":3"), "does not say what the frames hold"},
      {changed("\"frames\":[]", "\"frames\":{}"), "does not say what the frames hold"},
      {changed("\"name\":\"beam\"", "\"name\":17"), "does not say what the frames hold"},
      {changed("\"points\":5", "\"points\":1073741824"), "does not say what the frames hold"},
  };
  for (const auto& [text, message] : cases) {
    write_file(scratch / "m.bin", text);
    try {
      (void)read_motion_file(scratch / "m.bin", 10);
      ADD_FAILURE() << "accepted: " << text.substr(0, 300);
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  }
  std::string last_byte = good;  // of the check sum of the last frame
  last_byte.back() = static_cast<char>(last_byte.back() ^ 1);
  write_file(scratch / "m.bin", last_byte);
  try {
    (void)read_motion_file(scratch / "m.bin", 10);
    ADD_FAILURE() << "a damaged frame was taken";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("cannot be unpacked"), std::string::npos) << error.what();
  }
  write_file(scratch / "cut.bin", good.substr(0, good.size() - 3));
  EXPECT_EQ(read_motion_file(scratch / "cut.bin", 10).frames.size(), 2u);
}

TEST(Pvd, numbers_the_frames_where_load_factors_turn_back) {
  const std::string pvd = pvd_text({{0.0, "a"}, {0.9, "b"}, {0.4, "c"}});
  EXPECT_NE(pvd.find("timestep=\"1\" group=\"\" part=\"0\" file=\"b\""), std::string::npos) << pvd;
  EXPECT_NE(pvd.find("timestep=\"2\" group=\"\" part=\"0\" file=\"c\""), std::string::npos) << pvd;
}
TEST(Pvd, lists_the_frames_with_their_times) {
  const std::string pvd = pvd_text({{0.0, "motion/frame_000000.vtu"}, {0.1, "a&b\".vtu"}});
  EXPECT_NE(pvd.find("timestep=\"0.1\" group=\"\" part=\"0\" file=\"a&amp;b&quot;.vtu\""), std::string::npos) << pvd;
}

}  // namespace
}  // namespace bough::io
