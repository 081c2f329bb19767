"""What browsers get: the decoder in JavaScript, the viewer, and the page that holds both."""
