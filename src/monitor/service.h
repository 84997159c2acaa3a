#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "monitor/host_names.h"
#include "monitor/http_server.h"
#include "monitor/store.h"

namespace patrol::monitor {

/// HTTP API of the monitoring server: receives results and serves the page and its data.
///
/// Changes require the access token (`Authorization: Bearer ...`). Reading requires none: whoever can reach the address
/// can read. The token in a header also prevents cross-site request forgery, because browsers do not add this header.
///
///   POST /api/results                         a result or a list of them:
///                                             {"results": [{"id", "status": stored, known or conflict}]}
///   POST /api/alarms/<number>/acknowledge     {"who", "note"}
///   GET  /  /page.css  /page.js  ...  /schema
///   GET  /api/changes?since=  /api/robots?after=&limit=  /api/alarms?open=&before=&limit=
///        /api/run?robot=&run=&station=  /api/lining?world=&after=  /api/water?world=  /api/gas?world=
///        /api/history?robot=&kind=&before=&limit=  /api/maps/<number>
///
/// Every response is bounded; longer data are divided into pages (queries.h). `limit` is at most 200 rows. `before` is
/// the lowest number of the previous page, `after` its last robot or its `next`, and `station` its `next_station`.
class Service final : public HttpHandler {
 public:
  /// Requests for host names not in `hosts` are refused with 421.
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
