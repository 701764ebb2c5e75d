// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/written.hpp"
#include "support/sample_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <yaml-cpp/yaml.h>

#include <set>

namespace prodomos::exporter {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const map::MapView& sampleView() {
  static const test::SampleMap sample;
  static const map::MapView view = sample.view();
  return view;
}

TEST(Graphml, IsReadByNetworkx) {
  if (!test::runPython("import networkx", "").well) GTEST_SKIP() << "needs python3-networkx";
  const auto ran = test::runPython(R"(
import sys, networkx
graph = networkx.read_graphml(sys.argv[1], force_multigraph=True)
print(graph.number_of_nodes(), graph.number_of_edges(), graph.graph['log'])
print(graph.nodes['s3'])
print(graph.nodes['s6']['kind'], graph.nodes['s6']['probability'], 'readings' in graph.nodes['s6'])
print(graph['s2']['s3'])
print(networkx.shortest_path_length(graph, 's5', 's3', weight='weight'))
)",
                                   test::write("graphml", sampleView()));
  ASSERT_TRUE(ran.well) << ran.output;
  EXPECT_EQ(ran.output,
            "6 6 sample <&> \"map\".rawlog\n"
            "{'label': 's3', 'kind': 'observed', 'session': 'r1', 'floor': 0, 'place': 1, 'x': 5.0, 'y': 2.75, 'z': "
            "0.0, 'yaw': 1.570796, 'begin': '1000000020.0', 'end': '1000000030.0', 'distance': 8.0, 'readings': 30, "
            "'entities': 2}\n"
            "predicted 0.82 False\n"
            "{'e2': {'kind': 'door', 'cause': 'o1', 'weight': 2.75, 'dx': 0.0, 'dy': 2.75, 'dz': 0.0, 'dyaw': "
            "1.570796}}\n"
            "18.158327\n");
}

TEST(Dot, NamesNodesAndEdgesAndEscapesTheTitle) {
  const auto text = test::write("dot", sampleView());
  EXPECT_THAT(text, HasSubstr(R"(label="sample <&> \"map\".rawlog")"));
  EXPECT_THAT(text, HasSubstr("s2 -- s3 [id=e2, tooltip=\"door\""));
  EXPECT_THAT(text, HasSubstr("s6 [pos="));
}

TEST(Json, HoldsTheWholeMap) {
  const auto map = json::parse(test::write("json", sampleView()));
  EXPECT_EQ(map["format"], "prodomos map");
  EXPECT_EQ(map["version"], 1);
  EXPECT_EQ(map["sessions"][0]["log"], "sample <&> \"map\".rawlog");
  EXPECT_EQ(map["floors"].size(), 2U);
  EXPECT_EQ(map["nodes"].size(), 6U);
  EXPECT_EQ(map["edges"].size(), 6U);
  EXPECT_EQ(map["entities"].size(), 5U);
  EXPECT_EQ(map["trajectory"].size(), sampleView().trajectory().size());
  EXPECT_EQ(map["places"][0]["submaps"], json({"s1", "s2"}));
}

TEST(Json, SaysWhereThingsLie) {
  const auto map = json::parse(test::write("json", sampleView()));
  EXPECT_EQ(map["nodes"][2]["T_map_submap"]["position"], json({5.0, 2.75, 0.0}));
  EXPECT_NEAR(map["nodes"][2]["T_map_submap"]["yaw"], 1.570796327, 1e-9);
  EXPECT_EQ(map["nodes"][2]["layers"].size(), 2U);
  EXPECT_EQ(map["nodes"][5]["layers"].size(), 0U);
  const auto& door = map["entities"][0];
  EXPECT_EQ(door["class"], "door");
  EXPECT_EQ(door["T_map_entity"]["position"], json({5.5, 1.125, 1.0}));
  EXPECT_EQ(door["attributes"]["state"], "open");
}

TEST(Json, TellsExactTimesAndInformationMatrices) {
  const auto map = json::parse(test::write("json", sampleView()));
  EXPECT_EQ(map["nodes"][1]["begin"], "1000000010.0");
  EXPECT_THAT(map["edges"][0]["information"].get<std::vector<double>>(),
              ElementsAre(100, 10, 0, 0, 0, 0, 200, 0, 0, 0, 0, 300, 0, 0, 0, 400, 0, 0, 500, 0, 600));
}

TEST(Json, TellsTheCovariancesOfRefinedNodes) {
  const auto map = json::parse(test::write("json", sampleView()));
  EXPECT_TRUE(map["nodes"][0]["covariance"].is_null());
  EXPECT_THAT(map["nodes"][1]["covariance"].get<std::vector<double>>(),
              ElementsAre(0.01, 0, 0, 0, 0, 0, 0.01, 0, 0, 0, 0, 0.01, 0, 0, 0, 0.01, 0, 0, 0.01, 0, 0.01));
}

TEST(Json, KeepsPredictionsApart) {
  const auto map = json::parse(test::write("json", sampleView()));
  const auto& prediction = map["predictions"].at(0);
  EXPECT_EQ(prediction["node"], "s6");
  EXPECT_EQ(prediction["cause"], "o2");
  EXPECT_EQ(prediction["state"], "open");
  EXPECT_EQ(prediction["settled"], nullptr);
  EXPECT_EQ(prediction["areas"][0]["outline_in_node"][2], json({2.5, 2.0}));
}

TEST(Geojson, SaysThatItsMetresAreNotDegrees) {
  const auto map = json::parse(test::write("geojson", sampleView()));
  EXPECT_EQ(map["type"], "FeatureCollection");
  EXPECT_THAT(map["properties"]["coordinates"].get<std::string>(), HasSubstr("metres"));
}

TEST(Geojson, HoldsEachKindOfThingInItsGeometry) {
  const auto map = json::parse(test::write("geojson", sampleView()));
  std::map<std::string, int> counts;
  for (const auto& feature : map["features"]) {
    const std::string kind = feature["properties"]["feature"];
    ++counts[kind + ' ' + std::string(feature["geometry"]["type"])];
  }
  EXPECT_EQ(counts, (std::map<std::string, int>{{"edge LineString", 6},
                                                {"entity Point", 5},
                                                {"node Point", 6},
                                                {"predicted_area Polygon", 2},
                                                {"trajectory LineString", 1},
                                                {"trail LineString", 1}}));
}

TEST(Geojson, DrawsTheWayOfSomebodyWhoWasFollowedInTheMapFrame) {
  const auto map = json::parse(test::write("geojson", sampleView()));
  for (const auto& feature : map["features"]) {
    if (feature["properties"]["feature"] != "trail") continue;
    const auto& way = feature["geometry"]["coordinates"];
    ASSERT_EQ(way.size(), 3U);
    EXPECT_NEAR(way[0][0].get<double>(), 5.4, 1e-6);
    EXPECT_NEAR(way[2][1].get<double>(), 3.4, 1e-6);
    return;
  }
  FAIL() << "no trail";
}

TEST(Geojson, ClosesThePolygonsOfPredictedAreasInTheMapFrame) {
  const auto map = json::parse(test::write("geojson", sampleView()));
  for (const auto& feature : map["features"]) {
    if (feature["geometry"]["type"] != "Polygon") continue;
    const auto& ring = feature["geometry"]["coordinates"].at(0);
    EXPECT_EQ(ring.size(), 5U);
    EXPECT_EQ(ring.front(), ring.back());
    EXPECT_NEAR(ring.front().at(0), 9.25 - 1.2, 1e-9);
  }
}

std::vector<std::vector<double>> g2oLines(const std::string& text, const std::string& tag) {
  std::vector<std::vector<double>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    std::string word;
    fields >> word;
    if (word != tag) continue;
    rows.emplace_back();
    for (double value = 0; fields >> value;) rows.back().push_back(value);
  }
  return rows;
}

TEST(G2o, HoldsTheObservedPoseGraphAlone) {
  const auto text = test::write("g2o", sampleView());
  const auto vertices = g2oLines(text, "VERTEX_SE3:QUAT");
  const auto edges = g2oLines(text, "EDGE_SE3:QUAT");
  ASSERT_EQ(vertices.size(), 5U);
  ASSERT_EQ(edges.size(), 5U);
  const double half = std::sqrt(0.5);
  EXPECT_THAT(vertices[2], testing::Pointwise(testing::DoubleNear(1e-8), {3.0, 5.0, 2.75, 0.0, 0.0, 0.0, half, half}));
  for (const auto& edge : edges) EXPECT_EQ(edge.size(), 2U + 7U + 21U);
}

TEST(G2o, GivesTheInformationOfHalfAngles) {
  const auto edge = g2oLines(test::write("g2o", sampleView()), "EDGE_SE3:QUAT").at(1);
  const std::vector<double> information(edge.begin() + 9, edge.end());
  EXPECT_THAT(information, testing::Pointwise(testing::DoubleNear(1e-6), {100,  10, 0, 0, 0, 0,  //
                                                                          200,  0,  0, 0, 0,     //
                                                                          300,  0,  0, 0,        //
                                                                          1600, 0,  0,           //
                                                                          2000, 0,               //
                                                                          2400}));
}

TEST(Topomap, HasWhatTheReaderAsksFor) {
  const auto map = YAML::Load(test::write("topomap", sampleView()));
  for (const auto* const key : {"meta", "name", "metric_map", "pointset", "transformation", "actions", "nodes"}) {
    EXPECT_TRUE(map[key]) << key;
  }
  EXPECT_EQ(map["meta"]["last_updated"].as<std::string>(), "09-09-2001_01-47-30");  // the log's end, not today
  EXPECT_EQ(map["transformation"]["topo_frame_id"].as<std::string>(), "topo_map");
  std::set<std::string> names;
  for (const auto& item : map["nodes"]) names.insert(item["node"]["name"].as<std::string>());
  EXPECT_THAT(names, ElementsAre("s1", "s2", "s3", "s4", "s5"));  // nobody is sent to a room that was never seen
  for (const auto& item : map["nodes"]) {
    for (const auto* const key : {"edges", "localise_by_topic", "parent_frame", "pose", "properties", "verts"}) {
      EXPECT_TRUE(item["node"][key]) << key;
    }
    EXPECT_EQ(item["meta"]["pointset"].as<std::string>(), map["pointset"].as<std::string>());
    for (const auto& edge : item["node"]["edges"]) {
      EXPECT_TRUE(names.contains(edge["node"].as<std::string>()));
      EXPECT_TRUE(map["actions"][edge["action"].as<std::string>()]);
    }
  }
}

TEST(Topomap, LeadsBothWaysAlongEachConnection) {
  const auto map = YAML::Load(test::write("topomap", sampleView()));
  std::multiset<std::string> edges;
  for (const auto& item : map["nodes"]) {
    for (const auto& edge : item["node"]["edges"]) edges.insert(edge["edge_id"].as<std::string>());
  }
  EXPECT_THAT(edges, ElementsAre("s1_s2", "s1_s4", "s2_s1", "s2_s3", "s3_s2", "s4_s1", "s4_s5", "s5_s4"));
}

}  // namespace
}  // namespace prodomos::exporter
