// Locally convex connected patches (Stein et al. 2014) by the Point Cloud Library, with the
// defaults of its example and the sanity criterion of the paper.
// Usage: lccp_pcl CLOUD LABELS VOXEL SEED; prints the seconds of processor time. Lengths are metres. CLOUD: int32 n, then n float32 x y z and n bytes
// r g b. LABELS: n uint32, 0 for no segment.
#include <pcl/point_types.h>
#include <pcl/segmentation/lccp_segmentation.h>
#include <pcl/segmentation/supervoxel_clustering.h>

#include <cstdint>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

using Point = pcl::PointXYZRGBA;

int main(int, char **arguments) {
  const float voxel = std::stof(arguments[3]), seed = std::stof(arguments[4]);
  std::ifstream given(arguments[1], std::ios::binary);
  std::int32_t n = 0;
  given.read(reinterpret_cast<char *>(&n), sizeof n);
  std::vector<float> places(3 * n);
  std::vector<std::uint8_t> colours(3 * n);
  given.read(reinterpret_cast<char *>(places.data()), static_cast<std::streamsize>(places.size() * sizeof(float)));
  given.read(reinterpret_cast<char *>(colours.data()), static_cast<std::streamsize>(colours.size()));
  pcl::PointCloud<Point>::Ptr cloud(new pcl::PointCloud<Point>);
  for (std::int32_t i = 0; i < n; ++i) {
    Point point;
    point.x = places[3 * i], point.y = places[3 * i + 1], point.z = places[3 * i + 2];
    point.r = colours[3 * i], point.g = colours[3 * i + 1], point.b = colours[3 * i + 2], point.a = 255;
    cloud->push_back(point);
  }
  const std::clock_t started = std::clock();
  pcl::SupervoxelClustering<Point> clustering(voxel, seed);
  clustering.setUseSingleCameraTransform(false);
  clustering.setInputCloud(cloud);
  clustering.setColorImportance(0.0f);
  clustering.setSpatialImportance(1.0f);
  clustering.setNormalImportance(4.0f);
  std::map<std::uint32_t, pcl::Supervoxel<Point>::Ptr> supervoxels;
  clustering.extract(supervoxels);
  std::multimap<std::uint32_t, std::uint32_t> adjacency;
  clustering.getSupervoxelAdjacency(adjacency);
  pcl::LCCPSegmentation<Point> lccp;
  lccp.setConcavityToleranceThreshold(10.0f);
  lccp.setSmoothnessCheck(true, voxel, seed, 0.1f);
  lccp.setSanityCheck(true);
  lccp.setKFactor(0);
  lccp.setInputSupervoxels(supervoxels, adjacency);
  lccp.setMinSegmentSize(0);
  lccp.segment();
  pcl::PointCloud<pcl::PointXYZL>::Ptr labelled = clustering.getLabeledCloud();
  lccp.relabelCloud(*labelled);
  std::printf("%.6f\n", static_cast<double>(std::clock() - started) / CLOCKS_PER_SEC);
  std::vector<std::uint32_t> labels(n);
  for (std::int32_t i = 0; i < n; ++i) labels[i] = (*labelled)[i].label;
  std::ofstream found(arguments[2], std::ios::binary);
  found.write(reinterpret_cast<const char *>(labels.data()), static_cast<std::streamsize>(labels.size() * 4));
  return 0;
}
