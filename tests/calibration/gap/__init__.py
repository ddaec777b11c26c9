"""The blind study of naming: effects hidden on the virtual rig, found or not."""
