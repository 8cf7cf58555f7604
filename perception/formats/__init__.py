"""Read scenes from scene JSON, COCO, LabelMe and 3-D detections, and write them."""
