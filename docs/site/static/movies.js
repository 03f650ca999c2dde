// A picture that links to a movie becomes a player with the picture as its poster.
document.addEventListener("DOMContentLoaded", () => {
  for (const link of document.querySelectorAll('a[href$=".mp4"]')) {
    const picture = link.querySelector("img");
    if (!picture) continue;
    const movie = document.createElement("video");
    Object.assign(movie, { src: link.href, poster: picture.src, title: picture.alt, width: 480, height: 270 });
    Object.assign(movie, { controls: true, loop: true, playsInline: true, preload: "none" });
    link.replaceWith(movie);
  }
});
