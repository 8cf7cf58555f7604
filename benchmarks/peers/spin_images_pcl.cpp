// Spin images by PCL, for timing beside Deixis and for comparing results.
//
//   spin_images_pcl INPUT OUTPUT WIDTH SUPPORT COSINE RADIAL ANGULAR THREADS RUNS
//
// INPUT: two int32, the numbers of points n and of keypoints k; n * 3 float32 points; n * 3 float32 normals; k int32
// indices. OUTPUT: k * 153 float32, the first (WIDTH + 1) * (2 * WIDTH + 1) of which are the image; WIDTH is 8 or less.
// Each run builds the search tree and the images; their seconds go to standard output.

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <thread>
#include <vector>

#include <pcl/features/spin_image.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

struct Settings {
  int width;
  double support, cosine;
  bool radial, angular;
  int threads;
};

using Image = pcl::Histogram<153>;
using Points = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;
using Tree = pcl::search::KdTree<pcl::PointXYZ>;

static std::vector<Image> images(const Points::Ptr& points, const Normals::Ptr& normals,
                                 const std::vector<std::int32_t>& keypoints, const Settings& settings) {
  Tree::Ptr tree(new Tree(false));  // unsorted neighbours: the order does not matter to an image
  tree->setInputCloud(points);
  std::vector<Image> found(keypoints.size());
  auto part = [&](int which) {
    pcl::IndicesPtr mine(new pcl::Indices);
    for (std::size_t i = which; i < keypoints.size(); i += settings.threads) mine->push_back(keypoints[i]);
    pcl::SpinImageEstimation<pcl::PointXYZ, pcl::Normal, Image> estimation(settings.width, settings.cosine, 0);
    estimation.setRadialStructure(settings.radial);
    estimation.setAngularDomain(settings.angular);
    estimation.setInputCloud(points);
    estimation.setInputNormals(normals);
    estimation.setIndices(mine);
    estimation.setSearchMethod(tree);
    estimation.setRadiusSearch(settings.support);
    pcl::PointCloud<Image> result;
    estimation.compute(result);
    for (std::size_t i = 0; i < result.size(); ++i) found[which + i * settings.threads] = result[i];
  };
  std::vector<std::thread> workers;
  for (int which = 1; which < settings.threads; ++which) workers.emplace_back(part, which);
  part(0);
  for (auto& worker : workers) worker.join();
  return found;
}

int main(int argc, char** argv) {
  if (argc != 10) return 2;
  std::ifstream input(argv[1], std::ios::binary);
  std::int32_t counts[2];
  input.read(reinterpret_cast<char*>(counts), sizeof counts);
  std::vector<float> xyz(3 * counts[0]), directions(3 * counts[0]);
  std::vector<std::int32_t> keypoints(counts[1]);
  input.read(reinterpret_cast<char*>(xyz.data()), xyz.size() * sizeof(float));
  input.read(reinterpret_cast<char*>(directions.data()), directions.size() * sizeof(float));
  input.read(reinterpret_cast<char*>(keypoints.data()), keypoints.size() * sizeof(std::int32_t));
  if (!input) return 2;
  Points::Ptr points(new Points);
  Normals::Ptr normals(new Normals);
  for (int i = 0; i < counts[0]; ++i) {
    points->push_back({xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]});
    normals->push_back({directions[3 * i], directions[3 * i + 1], directions[3 * i + 2]});
  }
  const Settings settings{std::atoi(argv[3]),      std::atof(argv[4]),      std::atof(argv[5]),
                          std::atoi(argv[6]) != 0, std::atoi(argv[7]) != 0, std::atoi(argv[8])};
  std::vector<Image> found;
  for (int run = 0; run < std::atoi(argv[9]); ++run) {
    const auto started = std::chrono::steady_clock::now();
    found = images(points, normals, keypoints, settings);
    std::cout << std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count() << "\n";
  }
  std::ofstream output(argv[2], std::ios::binary);
  for (const auto& image : found) output.write(reinterpret_cast<const char*>(image.histogram), sizeof image.histogram);
}
