MODULE M
  PROC main()
    put 1,2;
    put;
  ENDPROC
  PROC put(num x,\switch fast)
    WaitTime x;
  ENDPROC
  PROC other()
    put 3;
  ENDPROC
ENDMODULE
