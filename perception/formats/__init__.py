"""Scenes as files: scene JSON, COCO and LabelMe."""
