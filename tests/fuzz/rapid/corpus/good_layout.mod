module m(SYSMODULE, NOSTEPIN)
proc MAIN()
set DO1;reset do1;if
1=1
then set do2;endif
;;
for I from 1 to 2 do waittime i;endfor
endproc
endmodule
