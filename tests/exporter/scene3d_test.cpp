// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/scene3d.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/exporter/view3d.hpp"

#include "support/sample_map.hpp"
#include "written.hpp"

#include <gtest/gtest.h>
#include <mrpt/maps/CPointsMap.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/opengl/CSphere.h>

#include <cmath>
#include <numbers>

namespace prodomos::exporter {
namespace {

using test::SampleMap;
using test::TemporaryFolder;

TEST(Scene3d, HoldsANodeForEachSubMapWhereItLies) {
  const SampleMap sample;
  const auto view = sample.view();
  const TemporaryFolder folder;
  const auto path = folder.path() / "map.3Dscene";
  findExporter("3dscene")->write(view, path);

  mrpt::opengl::COpenGLScene scene;
  ASSERT_TRUE(scene.loadFromFile(path.string()));
  for (const auto id : view.graph().nodes()) {
    const auto node = scene.getByName(toString(id));
    ASSERT_TRUE(node) << id;
    const auto pose = view.graph().getNode(id).T_map_submap;
    EXPECT_NEAR(node->getPoseX(), pose.translation().x(), 1e-6) << id;
    EXPECT_NEAR(node->getPoseY(), pose.translation().y(), 1e-6) << id;
  }
}

TEST(Scene3d, IsTheSameBytesEachTime) {
  const SampleMap sample;
  EXPECT_EQ(test::write("3dscene", sample.view()), test::write("3dscene", sample.view()));
}

TEST(Simplemap, HoldsAPoseAndThePointsOfEachObservedSubMap) {
  const SampleMap sample;
  const auto view = sample.view();
  const TemporaryFolder folder;
  const auto path = folder.path() / "map.simplemap";
  findExporter("simplemap")->write(view, path);

  mrpt::maps::CSimpleMap simplemap;
  ASSERT_TRUE(simplemap.loadFromFile(path.string()));
  ASSERT_EQ(simplemap.size(), 5U);  // the predicted one has seen nothing
  mrpt::poses::CPose3DPDF::Ptr pose;
  mrpt::obs::CSensoryFrame::Ptr frame;
  simplemap.get(1, pose, frame);
  const auto expected = view.graph().getNode({2}).T_map_submap.translation();
  EXPECT_NEAR(pose->getMeanVal().x(), expected.x(), 1e-9);
  const auto cloud = frame->getObservationByClass<mrpt::obs::CObservationPointCloud>();
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->sensorLabel, "s2");
}

TEST(Overview, SeesEveryCornerFromAsNearAsPossible) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-3.0, 2.0, 0.0), Eigen::Vector3d(17.0, 9.0, 3.0));
  for (const double widthToHeight : {0.5, 1.0, 1.6, 3.0}) {
    const auto viewpoint = overview(box, widthToHeight);
    const double azimuth = viewpoint.azimuth * std::numbers::pi / 180.0;
    const double elevation = viewpoint.elevation * std::numbers::pi / 180.0;
    const Eigen::Vector3d back(std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
                               std::sin(elevation));
    const Eigen::Vector3d right = Eigen::Vector3d::UnitZ().cross(back).normalized();
    const Eigen::Vector3d up = back.cross(right);
    const double tangent = std::tan(0.5 * viewpoint.fieldOfView * std::numbers::pi / 180.0);
    double fullest = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d point = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)) - viewpoint.target;
      const double depth = viewpoint.distance - point.dot(back);
      EXPECT_GT(depth, viewpoint.leastDepth());
      EXPECT_LT(depth, viewpoint.greatestDepth());
      fullest = std::max({fullest, std::abs(point.dot(up)) / (depth * tangent),
                          std::abs(point.dot(right)) / (depth * tangent * widthToHeight)});
    }
    EXPECT_LT(fullest, 1.0);
    EXPECT_GT(fullest, 0.85);
  }
}

TEST(Screenshot, IsAPngOfTheSizeAskedForWithoutADisplay) {
  unsetenv("DISPLAY");
  const SampleMap sample;
  const TemporaryFolder folder;
  renderScreenshot(sample.view(), folder.path() / "map.png", 321, 200);
  const auto bytes = test::readFile(folder.path() / "map.png");
  ASSERT_GT(bytes.size(), 1000U);
  EXPECT_EQ(bytes.substr(1, 3), "PNG");
  EXPECT_EQ(bytes.substr(16, 8), std::string("\x00\x00\x01\x41\x00\x00\x00\xC8", 8));  // 321 x 200
}

TEST(Screenshot, SaysWhereItCannotBeWritten) {
  const SampleMap sample;
  EXPECT_THROW(renderScreenshot(sample.view(), "/nowhere/map.png", 64, 64), base::FileError);
}

TEST(Window, RefusesAFileThatIsNoMap) {
  EXPECT_THROW(showWindow("/nowhere/map.prodomos", false), base::FileError);
}

}  // namespace
}  // namespace prodomos::exporter
