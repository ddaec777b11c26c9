"""Reports and documents, and the folder that holds them."""
