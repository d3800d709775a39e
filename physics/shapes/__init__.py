"""What a collider is: the six classes, and the records that kernels read of them."""
