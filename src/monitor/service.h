#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "monitor/host_names.h"
#include "monitor/http_server.h"
#include "monitor/store.h"

namespace patrol::monitor {

/// The platform behind its address: takes results in, and gives the page what it shows.
///
/// Whoever changes something shows the token (`Authorization: Bearer ...`); reading needs none: who may reach the address may see. The
/// token in a header also keeps other sites' pages from changing anything through a visitor's browser, which sends no such header for them.
///
///   POST /api/results                         a result or a list of them: {"results": [{"id", "status": stored, known or conflict}]}
///   POST /api/alarms/<number>/acknowledge     {"who", "note"}
///   GET  /  /page.css  /page.js  ...  /schema
///   GET  /api/changes?since=  /api/robots?after=&limit=  /api/alarms?open=&before=&limit=  /api/run?robot=&run=&station=
///        /api/lining?world=&after=  /api/water?world=  /api/gas?world=  /api/history?robot=&kind=&before=&limit=  /api/maps/<number>
///
/// Every answer has a limit, and what is longer comes in pages (queries.h): `limit` has at most 200 rows; `before` takes the lowest number
/// of the page before, `after` its last robot or its `next`, `station` its `next_station`.
class Service final : public HttpHandler {
 public:
  /// Requests under other host names than `hosts` allows are refused with 421.
  Service(Store& store, std::string token, HttpServer::Log log, HostNames hosts = HostNames());

  std::optional<HttpResponse> refuse(const HttpRequest& head) override;
  HttpResponse answer(const HttpRequest& request) override;

 private:
  HttpResponse take_results(const HttpRequest& request);
  HttpResponse acknowledge(const HttpRequest& request);

  Store& store_;
  std::string token_;
  HttpServer::Log log_;
  HostNames hosts_;
};

}  // namespace patrol::monitor
